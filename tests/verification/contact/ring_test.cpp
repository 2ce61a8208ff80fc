// A ring squeezed between plates against the inextensible elastica, by quadrature.
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>

#include "rom/base/smooth_ramp.hpp"
#include "tests/verification/support/run_scene.hpp"

namespace undula::verification {
namespace {

/// Force and height of a squeezed ring of mean radius 1 and bending stiffness 1. A quarter of it turns from
/// the flat of a plate (0) to its side (pi/2) by theta'^2 = top^2 + 2 k sin theta, k the force that each side
/// carries. On the plate `top` is the curvature until the ring lies flat (top = 0, a part of it straight).
struct Squeezed {
  double force = 0;  ///< of a plate, in E I / R^2
  double height = 0; ///< of the centreline, in R
};

/// int_0^{pi/2} f(theta) d theta; theta = s^2 takes the root at 0 out.
double integral(const std::function<double(double)>& f) {
  constexpr int pieces = 4000; // midpoint rule
  const double end = std::sqrt(std::numbers::pi / 2), h = end / pieces;
  double sum = 0;
  for (int i = 0; i < pieces; ++i) {
    const double s = (i + 0.5) * h;
    sum += 2 * s * f(s * s) * h;
  }
  return sum;
}

Squeezed squeezed(double k) {
  const double quarter = std::numbers::pi / 2;
  const auto length = [&](double top) {
    return integral([&](double theta) { return 1 / std::sqrt(top * top + 2 * k * std::sin(theta)); });
  };
  double top = 0;
  if (length(0) > quarter) { // it does not lie flat yet
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) (length(top = 0.5 * (low + high)) > quarter ? low : high) = top;
  }
  return {2 * k, 2 * integral([&](double theta) {
                   return std::sin(theta) / std::sqrt(top * top + 2 * k * std::sin(theta));
                 })};
}

double force_at(double height) {
  double low = 0, high = 1000;
  for (int i = 0; i < 60; ++i) {
    const double k = 0.5 * (low + high);
    (squeezed(k).height > height ? low : high) = k;
  }
  return squeezed(0.5 * (low + high)).force;
}

TEST(SqueezedRing, TheElasticaHasItsKnownLimits) {
  // Under a small force the height falls by (pi/4 - 2/pi) F R^3 / (E I): Timoshenko.
  EXPECT_NEAR((2 - squeezed(1e-3).height) / 2e-3, std::numbers::pi / 4 - 2 / std::numbers::pi, 1e-3);
  EXPECT_NEAR(squeezed(1.39320).height, 1.4355, 1e-3); // begins to lie flat
}

void expect_the_elastica(const std::vector<std::string>& settings, double tolerance) {
  const auto run = run_scene("ring_between_plates", settings);
  const auto load = run.column("upper_load_N_per_m"), below = run.column("lower_load_N_per_m");
  const double R = 1.0, wall = 0.06; // cm
  const double bending = 1e7 / (1 - 0.3 * 0.3) * wall * wall * wall / 12;
  double worst = 0;
  for (std::size_t k = 0; k < load.size(); ++k) {
    const double t = run.table.value(k, 0);
    const double way = 1.0 * smooth_ramp(t, 1); // cm
    const double height = 2 * R - way;
    if (way < 0.1) continue;
    const double expected = force_at(height / R) * bending / (R * R) / 1000; // N/m
    const double both = 0.5 * (load[k] + below[k]); // what moves and is damped takes the difference
    worst = std::max(worst, std::abs(both / expected - 1));
    if (k % 5 == 4)
      std::printf("  closed by %.3f R: %.4f, %.4f N/m, elastica %.4f (%+.2f %%)\n", way / R, load[k],
                  below[k], expected, 100 * (both / expected - 1));
  }
  std::printf("%d unknowns, worst %.2f %%\n", run.unknowns, 100 * worst);
  EXPECT_LT(worst, tolerance);
}

TEST(SqueezedRing, FollowsTheElasticaOnACoarseMesh) { expect_the_elastica({"time.step_s=0.02"}, 0.01); }
TEST(SqueezedRing, DISABLED_FollowsTheElasticaOnAFineMesh) {
  expect_the_elastica({"body.ring.size_mm=0.3", "time.step_s=0.02"}, 0.01);
}

} // namespace
} // namespace undula::verification
