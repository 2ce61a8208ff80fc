// What is measured of any cut: repeated while a solid moves, in floating point or in exact arithmetic,
// prepared, numbered, matched. A Case has `background`, `solids` and placed(step), the solids moved.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>

#include "geometry/cut/cut.hpp"
#include "geometry/cut/dof_matching.hpp"

namespace undula::geometry::bench {

template <int dim, class Case>
void cut(benchmark::State& state, bool exact) {
  const Case solid(state);
  CutOptions options;
  options.exact = exact;
  const BackgroundCutter<dim> cutter(solid.background, solid.solids, options);
  int step = 0;
  double cut_cells = 0, exact_cells = 0, simplices = 0;
  for (auto _ : state) {
    state.PauseTiming();
    const auto solids = solid.placed(step++);
    state.ResumeTiming();
    const auto result = cutter.cut(solids);
    benchmark::DoNotOptimize(result.parts.data());
    state.PauseTiming();
    for (std::size_t c = 0; c < result.mesh.cells.size(); ++c)
      cut_cells += result.cell_parts[c + 1] > result.cell_parts[c] && result.parts[result.cell_parts[c]].cut;
    if (!exact) exact_cells += result.exact_cells;
    simplices += static_cast<double>(result.simplices.size());
    state.ResumeTiming();
  }
  state.counters["cells"] = static_cast<double>(solid.background.cells.size());
  state.counters["cut_cells"] = cut_cells / step;
  state.counters["fell_back"] = exact_cells / step;
  state.counters["simplices_per_cut_cell"] = simplices / cut_cells;
  // Inverted rate: seconds per cut cell.
  state.counters["s_per_cut_cell"] =
      benchmark::Counter(cut_cells, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

template <int dim, class Case>
void prepare(benchmark::State& state) {
  const Case solid(state);
  for (auto _ : state) {
    const BackgroundCutter<dim> cutter(solid.background, solid.solids, {});
    benchmark::DoNotOptimize(&cutter);
  }
}

template <int dim, class Case>
void number(benchmark::State& state) {
  const Case solid(state);
  const auto result = BackgroundCutter<dim>(solid.background, solid.solids, {}).cut(solid.placed(0));
  std::size_t unknowns = 0;
  for (auto _ : state) unknowns = build_dof_sets(result).dof_point.size();
  state.counters["scalar_unknowns"] = static_cast<double>(unknowns);
}

template <int dim, class Case>
void match(benchmark::State& state) {
  const Case solid(state);
  const BackgroundCutter<dim> cutter(solid.background, solid.solids, {});
  const auto before = cutter.cut(solid.placed(0)), now = cutter.cut(solid.placed(1));
  const auto dofs_before = build_dof_sets(before), dofs_now = build_dof_sets(now);
  int fresh = 0;
  for (auto _ : state) {
    const auto matched = match_dofs(before, dofs_before, now, dofs_now);
    fresh = static_cast<int>(std::count(matched.begin(), matched.end(), -1));
  }
  state.counters["new_unknowns"] = fresh;
}

} // namespace undula::geometry::bench
