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

#include "geometry/mesh/box_mesh.hpp"
#include "tests/bench/cut_measures.hpp"

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

void cut_in_floating_point(benchmark::State& state) { bench::cut<3, Plate>(state, false); }
void cut_in_exact_arithmetic(benchmark::State& state) { bench::cut<3, Plate>(state, true); }
void prepare_the_background(benchmark::State& state) { bench::prepare<3, Plate>(state); }
void number_the_unknowns(benchmark::State& state) { bench::number<3, Plate>(state); }
void match_the_unknowns(benchmark::State& state) { bench::match<3, Plate>(state); }

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
