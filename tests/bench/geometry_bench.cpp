// The cut of the pump's background repeated while its membrane waves: microseconds per cut cell in floating
// point and in exact arithmetic, share of the cells that fell back on exact arithmetic, numbering and
// matching of the unknowns. Arguments: elements across a gap, amplitude of the wave in units of 0.001 cm.
// Sample run: geometry_bench --benchmark_min_time=1
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "geometry/cut/cut.hpp"
#include "geometry/cut/dof_matching.hpp"
#include "geometry/wave_pump/pump.hpp"

namespace {

using namespace undula::geometry;

struct Pump {
  explicit Pump(const benchmark::State& state) : amplitude(1e-3 * static_cast<double>(state.range(1))) {
    const auto profile =
        read_pump_profile(std::string(UNDULA_SOURCE_DIR) + "/data/profiles/wave_pump_profile.toml");
    const PumpMeshSizes sizes{static_cast<double>(state.range(0)), 0.08, 0.04, 0.3};
    background = pump_background(profile, sizes);
    solids = {pump_membrane(profile, sizes), pump_magnet(profile, sizes)};
  }

  /// The membrane with a wave travelling inwards, both solids lifted a little.
  std::vector<SimplexMesh<2>> placed(int step) const {
    auto moved = solids;
    const double phase = 2 * std::numbers::pi * step / 96.3;
    for (auto& p : moved[0].points) p[1] += amplitude * std::sin(5 * p[0] + phase);
    for (auto& p : moved[1].points) p[1] += amplitude * std::sin(phase);
    return moved;
  }

  double amplitude;
  SimplexMesh<2> background;
  std::vector<SimplexMesh<2>> solids;
};

void cut(benchmark::State& state, bool exact) {
  const Pump pump(state);
  CutOptions options;
  options.exact = exact;
  const BackgroundCutter<2> cutter(pump.background, pump.solids, options);
  int step = 0;
  double cut_cells = 0, exact_cells = 0;
  for (auto _ : state) {
    state.PauseTiming();
    const auto solids = pump.placed(step++);
    state.ResumeTiming();
    const auto result = cutter.cut(solids);
    benchmark::DoNotOptimize(result.parts.data());
    state.PauseTiming();
    for (std::size_t c = 0; c < result.mesh.cells.size(); ++c)
      cut_cells += result.cell_parts[c + 1] > result.cell_parts[c] && result.parts[result.cell_parts[c]].cut;
    if (!exact) exact_cells += result.exact_cells;
    state.ResumeTiming();
  }
  state.counters["cells"] = static_cast<double>(pump.background.cells.size());
  state.counters["cut_cells"] = cut_cells / step;
  state.counters["fell_back"] = exact_cells / step;
  // Inverted rate: seconds per cut cell.
  state.counters["s_per_cut_cell"] =
      benchmark::Counter(cut_cells, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void cut_in_floating_point(benchmark::State& state) { cut(state, false); }
void cut_in_exact_arithmetic(benchmark::State& state) { cut(state, true); }

void prepare_the_background(benchmark::State& state) {
  const Pump pump(state);
  for (auto _ : state) {
    const BackgroundCutter<2> cutter(pump.background, pump.solids, {});
    benchmark::DoNotOptimize(&cutter);
  }
}

void number_the_unknowns(benchmark::State& state) {
  const Pump pump(state);
  const auto result = BackgroundCutter<2>(pump.background, pump.solids, {}).cut(pump.placed(0));
  std::size_t unknowns = 0;
  for (auto _ : state) unknowns = build_dof_sets(result).dof_point.size();
  state.counters["scalar_unknowns"] = static_cast<double>(unknowns);
}

void match_the_unknowns(benchmark::State& state) {
  const Pump pump(state);
  const BackgroundCutter<2> cutter(pump.background, pump.solids, {});
  const auto before = cutter.cut(pump.placed(0)), now = cutter.cut(pump.placed(1));
  const auto dofs_before = build_dof_sets(before), dofs_now = build_dof_sets(now);
  int fresh = 0;
  for (auto _ : state) {
    const auto match = match_dofs(before, dofs_before, now, dofs_now);
    fresh = static_cast<int>(std::count(match.begin(), match.end(), -1));
  }
  state.counters["new_unknowns"] = fresh;
}

// Amplitude 0: the membrane at rest, as drawn.
void sizes(benchmark::internal::Benchmark* bench) {
  for (const int elements : {2, 5}) // 5: the mesh of data/scenes/wave_pump_fixed.toml
    for (const int amplitude : {0, 10}) bench->Args({elements, amplitude});
  bench->Unit(benchmark::kMillisecond);
}

BENCHMARK(cut_in_floating_point)->Apply(sizes);
BENCHMARK(cut_in_exact_arithmetic)->Apply(sizes);
BENCHMARK(prepare_the_background)->Apply(sizes);
BENCHMARK(number_the_unknowns)->Apply(sizes);
BENCHMARK(match_the_unknowns)->Apply(sizes);

} // namespace

BENCHMARK_MAIN();
