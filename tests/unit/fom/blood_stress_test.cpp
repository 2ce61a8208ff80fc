// Scalar stress and power law on flows whose stress is the same everywhere; the map of the wall shear.
#include "fom/output/blood_stress.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fom/output/wall_shear_map.hpp"
#include "tests/verification/support/channel_problem.hpp"

namespace undula::fom {
namespace {

using namespace verification;
using Sizes = ChannelSizes;
constexpr double pi = std::numbers::pi;
constexpr BloodDamageLaw law{1.228e-5, 1.9918, 0.6606, 0.2};

Discretisation<2> empty_channel(Space space) {
  auto problem = channel_with_plate(space);
  problem.solids.clear();
  return discretise(std::move(problem), CutOptions{});
}

// In plane shear at the rate g the scalar stress is that of the wall, viscosity * g.
TEST(BloodStress, IsTheShearStressOfCouetteFlow) {
  const auto disc = empty_channel(Space::plane);
  const auto x = interpolate_velocity(disc, [](const Point<2>& at) { return Point<2>(7 * at[1], 0); });
  const auto stress = blood_stress(disc, law, x);
  const double tau = 0.05 * 7, volume = Sizes::radius * Sizes::height;
  EXPECT_NEAR(stress.maximum, tau, 1e-12);
  EXPECT_NEAR(stress.stressed_volume, volume, 1e-12);
  // All blood stays for volume / flow seconds at that stress: the law itself.
  const double flow = 0.3, percent = 1.228e-5 * std::pow(0.1 * tau, 1.9918) * std::pow(volume / flow, 0.6606);
  EXPECT_NEAR(haemolysis_percent(law, stress.damage_rate, flow), percent, 1e-10 * percent);
}

// u = (a r, -2 a z): the hoop strains as the radius does.
TEST(BloodStress, CountsTheHoop) {
  const auto disc = empty_channel(Space::axisymmetric);
  const auto x =
      interpolate_velocity(disc, [](const Point<2>& at) { return Point<2>(3 * at[0], -6 * at[1]); });
  const auto stress = blood_stress(disc, law, x);
  EXPECT_NEAR(stress.maximum, 0.05 * std::sqrt(12.0) * 3, 1e-12);
  EXPECT_NEAR(stress.stressed_volume, pi * Sizes::radius * Sizes::radius * Sizes::height, 1e-10);
}

TEST(BloodStress, VanishesInRigidMotion) {
  const auto disc = empty_channel(Space::plane);
  const auto x =
      interpolate_velocity(disc, [](const Point<2>& at) { return Point<2>(2 - 3 * at[1], 3 * at[0]); });
  const auto stress = blood_stress(disc, law, x);
  EXPECT_LT(stress.maximum, 1e-12);
  EXPECT_EQ(stress.stressed_volume, 0);
  EXPECT_TRUE(std::isnan(haemolysis_percent(law, 1, 0)));
  EXPECT_TRUE(std::isnan(haemolysis_percent(law, 1, -2)));
}

TEST(WallShearMap, KeepsTheLastWholePeriod) {
  WallShearMap map(3);
  const auto add = [&](int step, double a, double b) {
    const double shear[] = {a, b};
    map.add(step, shear);
  };
  add(2, 100, 100); // a restart amid a period
  add(3, 100, 100);
  EXPECT_FALSE(map.has_period());
  add(4, 1, 4);
  add(5, 2, 5);
  EXPECT_FALSE(map.has_period());
  add(6, 6, 0);
  ASSERT_TRUE(map.has_period());
  EXPECT_EQ(map.period(), 2);
  EXPECT_EQ(map.mean()[0], 3);
  EXPECT_EQ(map.mean()[1], 3);
  EXPECT_EQ(map.maximum()[0], 6);
  EXPECT_EQ(map.maximum()[1], 5);
  add(7, 50, 50); // the next one is not whole
  EXPECT_EQ(map.mean()[0], 3);
}

} // namespace
} // namespace undula::fom
