// Milliseconds per 12-point head-flow curve of a reduced model, on synthetic operators of realistic sizes.
// Sample run: rom_bench --benchmark_min_time=1
#include <benchmark/benchmark.h>

#include "rom/curve/hq_curve.hpp"
#include "rom/fixed_domain/time_march.hpp"
#include "tests/unit/rom/synthetic_operators.hpp"

namespace {

using namespace undula::rom;

Model synthetic_model(const benchmark::State& state) {
  Model model;
  const SyntheticSizes sizes{static_cast<int>(state.range(0)), static_cast<int>(state.range(1)),
                             static_cast<int>(state.range(2))};
  model.operators = synthetic_operators(sizes, static_cast<double>(state.range(3)));
  model.steps_per_period = 96;
  return model;
}

std::vector<double> twelve_heads() {
  std::vector<double> heads;
  for (int i = 0; i < 12; ++i) heads.push_back(40 + 2 * i);
  return heads;
}

void curve(benchmark::State& state, bool estimate_errors) {
  const auto model = synthetic_model(state);
  const auto heads = twelve_heads();
  HqOptions options;
  options.estimate_errors = estimate_errors;
  double newton = 0, krylov = 0, direct = 0;
  for (auto _ : state) {
    newton = krylov = direct = 0;
    for (const auto& point : hq_curve(model, 120, 0.53, heads, options)) {
      newton += point.newton_iterations;
      krylov += point.krylov_iterations;
      direct += point.direct;
    }
  }
  state.counters["newton"] = newton;
  state.counters["krylov"] = krylov;
  state.counters["direct"] = direct;
}

void hq_curve_12_points(benchmark::State& state) { curve(state, false); }
void hq_curve_12_points_with_error(benchmark::State& state) { curve(state, true); }

void one_period_of_the_march(benchmark::State& state) {
  const auto model = synthetic_model(state);
  TimeMarch march(model.operators, {120, 0.053, 5e4}, model.steps_per_period, 2);
  for (auto _ : state) march.period();
}

// nu, np, nv, strength of convection
void sizes(benchmark::internal::Benchmark* bench) {
  for (const int convection : {10, 100}) {
    bench->Args({40, 20, 10, convection});
    bench->Args({60, 30, 12, convection});
    bench->Args({80, 40, 15, convection});
  }
  bench->Unit(benchmark::kMillisecond);
}

BENCHMARK(hq_curve_12_points)->Apply(sizes);
BENCHMARK(hq_curve_12_points_with_error)->Apply(sizes);
BENCHMARK(one_period_of_the_march)->Apply(sizes);

} // namespace

BENCHMARK_MAIN();
