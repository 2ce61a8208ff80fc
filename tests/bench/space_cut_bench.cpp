// The cut in space: microseconds per cut cell in floating point and in exact arithmetic, share of the cells
// that fell back on exact arithmetic. A bent plate, thinner than the elements, waves through a box of
// tetrahedra. Arguments: bricks of six tetrahedra along a side of the box, elements along the plate, height
// of the wave in hundredths of the side (0: flat), shift of the plate in ten-thousandths of the side (0:
// edges of the plate lie in planes of the grid).
//
// Sample run: space_cut_bench --benchmark_min_time=1
#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "geometry/cut/cut.hpp"
#include "geometry/cut/dof_matching.hpp"
#include "geometry/mesh/box_mesh.hpp"

namespace {

using namespace undula::geometry;

struct Plate {
  explicit Plate(const benchmark::State& state) : height(0.01 * static_cast<double>(state.range(2))) {
    const int bricks = static_cast<int>(state.range(0)), along = static_cast<int>(state.range(1));
    background = box_mesh({{0, 0, 0}, {1, 1, 1}}, {bricks, bricks, bricks});
    const double shift = 1e-4 * static_cast<double>(state.range(3));
    solids = {box_mesh({{0.1 + shift, 0.15 + shift, 0.495}, {0.9, 0.85, 0.515}}, {along, along, 2})};
    solids[0].boundary.clear();
  }

  std::vector<SimplexMesh<3>> placed(int step) const {
    auto moved = solids;
    const double phase = 2 * std::numbers::pi * step / 96.3;
    for (auto& p : moved[0].points) p[2] += height * std::sin(6 * p[0] + phase) * std::cos(3 * p[1]);
    return moved;
  }

  double height;
  SimplexMesh<3> background;
  std::vector<SimplexMesh<3>> solids;
};

void cut(benchmark::State& state, bool exact) {
  const Plate plate(state);
  CutOptions options;
  options.exact = exact;
  const BackgroundCutter<3> cutter(plate.background, plate.solids, options);
  int step = 0;
  double cut_cells = 0, exact_cells = 0, simplices = 0;
  for (auto _ : state) {
    state.PauseTiming();
    const auto solids = plate.placed(step++);
    state.ResumeTiming();
    const auto result = cutter.cut(solids);
    benchmark::DoNotOptimize(result.parts.data());
    state.PauseTiming();
    for (std::size_t c = 0; c < result.mesh.cells.size(); ++c)
      cut_cells += result.cell_parts[c + 1] > result.cell_parts[c] && result.parts[result.cell_parts[c]].cut;
    simplices += static_cast<double>(result.simplices.size());
    if (!exact) exact_cells += result.exact_cells;
    state.ResumeTiming();
  }
  state.counters["cells"] = static_cast<double>(plate.background.cells.size());
  state.counters["cut_cells"] = cut_cells / step;
  state.counters["fell_back"] = exact_cells / step;
  state.counters["simplices_per_cut_cell"] = simplices / cut_cells;
  // Inverted rate: seconds per cut cell.
  state.counters["s_per_cut_cell"] =
      benchmark::Counter(cut_cells, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void cut_in_floating_point(benchmark::State& state) { cut(state, false); }
void cut_in_exact_arithmetic(benchmark::State& state) { cut(state, true); }

void prepare_the_background(benchmark::State& state) {
  const Plate plate(state);
  for (auto _ : state) {
    const BackgroundCutter<3> cutter(plate.background, plate.solids, {});
    benchmark::DoNotOptimize(&cutter);
  }
}

void number_the_unknowns(benchmark::State& state) {
  const Plate plate(state);
  const auto result = BackgroundCutter<3>(plate.background, plate.solids, {}).cut(plate.placed(0));
  std::size_t unknowns = 0;
  for (auto _ : state) unknowns = build_dof_sets(result).dof_point.size();
  state.counters["scalar_unknowns"] = static_cast<double>(unknowns);
}

void match_the_unknowns(benchmark::State& state) {
  const Plate plate(state);
  const BackgroundCutter<3> cutter(plate.background, plate.solids, {});
  const auto before = cutter.cut(plate.placed(0)), now = cutter.cut(plate.placed(1));
  const auto dofs_before = build_dof_sets(before), dofs_now = build_dof_sets(now);
  for (auto _ : state) {
    const auto match = match_dofs(before, dofs_before, now, dofs_now);
    benchmark::DoNotOptimize(match.data());
  }
}

BENCHMARK(cut_in_floating_point)
    ->Args({24, 20, 5, 13})
    ->Args({24, 40, 5, 13})
    ->Args({24, 20, 0, 13})
    ->Args({24, 20, 5, 0})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(cut_in_exact_arithmetic)->Args({12, 10, 5, 13})->Unit(benchmark::kMillisecond);
BENCHMARK(prepare_the_background)->Args({24, 20, 5, 13})->Unit(benchmark::kMillisecond);
BENCHMARK(number_the_unknowns)->Args({24, 20, 5, 13})->Unit(benchmark::kMillisecond);
BENCHMARK(match_the_unknowns)->Args({24, 20, 5, 13})->Unit(benchmark::kMillisecond);

} // namespace

BENCHMARK_MAIN();
