// Closures of the flow along a hose, and its wall pressed flat, against independent numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "fom/long_wave/flattened_ring.hpp"
#include "fom/long_wave/hose_friction.hpp"

namespace undula::fom {
namespace {

using std::numbers::pi;

/// Integral of w with -lap w = 1 over a stadium of height h whose outline is 2 pi a long, w = 0 on it: finite
/// differences on a quarter, with the boundary at its own distance (Shortley & Weller), by relaxation.
double conductance_by_differences(double a, double h, int half_height_cells) {
  const int n = half_height_cells;
  const double flat = pi * (a - h / 2), top_flat = h / 2, end = flat / 2 + top_flat, d = top_flat / n;
  const int columns = static_cast<int>(end / d) + 2;
  const auto top = [&](double x) {
    if (x <= flat / 2) return top_flat;
    return std::sqrt(std::max(0.0, top_flat * top_flat - (x - flat / 2) * (x - flat / 2)));
  };
  const auto right = [&](double y) {
    return flat / 2 + std::sqrt(std::max(0.0, top_flat * top_flat - y * y));
  };
  std::vector<double> w(static_cast<std::size_t>((columns + 1) * (n + 1)), 0.0);
  const auto at = [&](int i, int j) -> double& { return w[static_cast<std::size_t>(i * (n + 1) + j)]; };
  const double relaxation = 2 / (1 + pi / (1.2 * n)), tiny = 1e-12 * h;
  for (int sweep = 0; sweep < 20000; ++sweep) {
    double change = 0;
    for (int i = 0; i <= columns; ++i)
      for (int j = 0; j <= n; ++j) {
        const double x = i * d, y = j * d;
        if (y >= top(x) - tiny) continue;
        const double east = std::min(d, right(y) - x), north = std::min(d, top(x) - y);
        const double we = east < d - tiny ? 0 : at(i + 1, j), wn = north < d - tiny ? 0 : at(i, j + 1);
        // Mirrored where the quarter begins.
        const double west = i == 0 ? east : d, south = j == 0 ? north : d;
        const double ww = i == 0 ? we : at(i - 1, j), ws = j == 0 ? wn : at(i, j - 1);
        const double value = (1 + 2 * we / (east * (east + west)) + 2 * ww / (west * (east + west)) +
                              2 * wn / (north * (north + south)) + 2 * ws / (south * (north + south))) /
                             (2 / (east * west) + 2 / (north * south));
        change = std::max(change, std::abs(value - at(i, j)));
        at(i, j) += relaxation * (value - at(i, j));
      }
    if (change < 1e-11 * h * h) break;
  }
  const auto column = [&](int i) {
    double sum = 0;
    int j = 0;
    for (; (j + 1) * d < top(i * d) - tiny; ++j) sum += 0.5 * d * (at(i, j) + at(i, j + 1));
    return sum + 0.5 * (top(i * d) - j * d) * at(i, j);
  };
  double total = 0;
  for (int i = 0; (i + 1) * d < end - tiny; ++i) total += 0.5 * d * (column(i) + column(i + 1));
  return 4 * total;
}

TEST(HoseFriction, TheConductanceOfAFlatBoreIsThatOfItsDevelopedFlow) {
  constexpr double a = 1;
  EXPECT_NEAR(flattened_conductance(a, 2 * a), pi / 8, 1e-15);
  EXPECT_NEAR(flattened_conductance(a, 1e-4) / (pi * 1e-12 / 12), 1, 1e-4);
  for (const double h : {1.9, 1.7, 1.5, 1.2, 0.8, 0.4}) {
    const double solved = conductance_by_differences(a, h, 40);
    EXPECT_NEAR(flattened_conductance(a, h) / solved, 1, 0.005) << h;
  }
  // The differences themselves, where the answer is known.
  EXPECT_NEAR(conductance_by_differences(a, 2 * a, 40) / (pi / 8), 1, 0.002);
}

TEST(HoseFriction, TurbulentFrictionIsBlasiusAndJoinsTheLaminarOne) {
  EXPECT_EQ(turbulent_factor(500), 1);
  EXPECT_NEAR(turbulent_factor(1000.001), 1, 1e-9);
  EXPECT_NEAR(turbulent_factor(2000), 1, 0.02);
  for (const double reynolds : {1e4, 2.1e4, 1e5}) {
    const double friction = turbulent_factor(reynolds) * 64 / reynolds;
    EXPECT_NEAR(friction / (0.3164 * std::pow(reynolds, -0.25)), 1, 0.03) << reynolds;
  }
}

TEST(FlattenedRing, SmallForcesGiveTheDeflectionOfACircularRing) {
  // Timoshenko: (pi / 4 - 2 / pi) F a^3 / B on either side together.
  constexpr double a = 2, stiffness = 3, deflection = 1e-4 * a;
  const auto ring = flattened_ring(a, stiffness, 2 * a - deflection);
  EXPECT_NEAR(deflection, (pi / 4 - 2 / pi) * ring.force * a * a * a / stiffness, 1e-3 * deflection);
  EXPECT_NEAR(ring.energy, 0.5 * ring.force * deflection, 1e-3 * ring.energy);
  EXPECT_EQ(flattened_ring(a, stiffness, 2 * a).force, 0);
}

TEST(FlattenedRing, BelowTheFlatHeightTheForceGoesWithTheInverseSquare) {
  // (int sqrt(sin) over half a turn)^2 = (sqrt(pi) Gamma(3/4) / Gamma(5/4))^2.
  const double integral = std::sqrt(pi) * std::tgamma(0.75) / std::tgamma(1.25);
  for (const double height : {1.3, 0.8, 0.2})
    EXPECT_NEAR(flattened_ring(1, 1, height).force * height * height, integral * integral, 1e-4);
  // Just above, the parts that touch are not flat yet, and the force is the same.
  EXPECT_NEAR(flattened_ring(1, 1, 1.436).force, integral * integral / (1.436 * 1.436), 0.01);
}

TEST(FlattenedRing, TheForceIsTheDerivativeOfTheEnergy) {
  constexpr double step = 1e-4;
  for (const double height : {1.95, 1.7, 1.5, 1.43, 1.0, 0.4}) {
    const double slope =
        (flattened_ring(1, 1, height - step).energy - flattened_ring(1, 1, height + step).energy) /
        (2 * step);
    EXPECT_NEAR(flattened_ring(1, 1, height).force / slope, 1, 2e-3) << height;
  }
}

TEST(FlattenedRing, TheTableRepeatsTheRing) {
  const FlattenedRing table(2.35, 7.0);
  for (const double height : {1.9, 2.2, 3.1, 4.0, 4.69}) {
    const auto expected = flattened_ring(2.35, 7.0, height), seen = table(height);
    EXPECT_NEAR(seen.force, expected.force, 1e-4 * table(1.9).force) << height;
    EXPECT_NEAR(seen.energy, expected.energy, 1e-4 * table(1.9).energy) << height;
  }
}

} // namespace
} // namespace undula::fom
