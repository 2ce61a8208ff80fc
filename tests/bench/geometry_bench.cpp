// The cut of the pump's background repeated while its membrane waves: microseconds per cut cell in floating
// point and in exact arithmetic, share of the cells that fell back on exact arithmetic, numbering and
// matching of the unknowns. Arguments: elements across a gap, amplitude of the wave in units of 0.001 cm.
// Sample run: geometry_bench --benchmark_min_time=1
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "geometry/wave_pump/pump.hpp"
#include "tests/bench/cut_measures.hpp"

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

void cut_in_floating_point(benchmark::State& state) { bench::cut<2, Pump>(state, false); }
void cut_in_exact_arithmetic(benchmark::State& state) { bench::cut<2, Pump>(state, true); }
void prepare_the_background(benchmark::State& state) { bench::prepare<2, Pump>(state); }
void number_the_unknowns(benchmark::State& state) { bench::number<2, Pump>(state); }
void match_the_unknowns(benchmark::State& state) { bench::match<2, Pump>(state); }

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
