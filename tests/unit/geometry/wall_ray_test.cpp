// Vertical rays from the membrane to the walls.
#include "geometry/wave_pump/wall_ray.hpp"

#include <gtest/gtest.h>

#include "simple_pump.hpp"

namespace undula::geometry {
namespace {

void expect_wall(double r, double z, bool up, double expected_z, FluidOutline::Curve curve) {
  const auto found = first_wall(fluid_outline(simple_pump()), r, z, up);
  ASSERT_TRUE(found.has_value()) << r << ", " << z;
  EXPECT_NEAR(found->z, expected_z, 1e-14) << r << ", " << z;
  EXPECT_EQ(found->curve, curve) << r << ", " << z;
}

TEST(FirstWall, MeetsTheNearestEdgeAndNamesItsCurve) {
  expect_wall(1.0, 0.1, true, 0.5, FluidOutline::stator);
  expect_wall(1.0, -0.1, false, -0.5, FluidOutline::housing);
  expect_wall(2.5, 0.1, true, 2.0, FluidOutline::housing); // beside the stator, past the magnet
  expect_wall(0.3, 0.0, false, -2.0, FluidOutline::outlet);
  expect_wall(0.3, 1.6, true, 3.0, FluidOutline::inlet);
}

TEST(FirstWall, DoesNotCountThePlaceItStartsFrom) {
  expect_wall(1.0, 0.5, true, 1.5, FluidOutline::stator);
  expect_wall(1.0, 1.5, false, 0.5, FluidOutline::stator);
}

TEST(FirstWall, DoesNotCountParallelEdges) {
  expect_wall(3.0, 0.0, true, 2.0, FluidOutline::housing);
  expect_wall(3.0, 0.0, false, -0.5, FluidOutline::housing);
}

TEST(FirstWall, InterpolatesInclinedEdges) {
  auto profile = simple_pump();
  profile.stator.points[2] = {2.0, 0.7}; // flange from (2, 0.7) to (0, 0.5)
  const auto found = first_wall(fluid_outline(profile), 0.5, 0.0, true);
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->z, 0.55, 1e-14);
}

TEST(FirstWall, IsEmptyWhereThereIsNone) {
  const auto outline = fluid_outline(simple_pump());
  EXPECT_FALSE(first_wall(outline, 5.0, 0.0, true).has_value());
  EXPECT_FALSE(first_wall(outline, 1.0, 2.5, true).has_value());
}

} // namespace
} // namespace undula::geometry
