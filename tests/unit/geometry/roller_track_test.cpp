// A hose between rollers and track, against quadrature and by limits.
#include "geometry/hose/roller_track.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geometry/hose/flattened_bore.hpp"

namespace undula::geometry {
namespace {

using std::numbers::pi;

RollerTrack small_pump(double gap) { return {0.3, 0.16, 5.0, pi, 1.0, 3, gap}; }

/// Area that the open bore has more, integrated along the squeezed piece.
double missing_by_quadrature(const RollerTrack& track, double gap) {
  const double a = track.bore_radius, r = relative_radius(track), reach = half_reach(track, gap);
  constexpr int panels = 20000;
  double sum = 0;
  for (int i = 0; i < panels; ++i) {
    const double s = -reach + 2 * reach * (i + 0.5) / panels;
    sum += pi * a * a - flattened_area(a, gap + s * s / (2 * r));
  }
  return sum * 2 * reach / panels;
}

TEST(RollerTrack, MissingVolumeIsTheIntegralOfTheMissingArea) {
  for (const double gap : {0.001, 0.1, 0.3, 0.55}) {
    const RollerTrack track = small_pump(gap);
    const double expected = missing_by_quadrature(track, gap);
    EXPECT_NEAR(missing_volume(track, gap), expected, 1e-7 * expected) << gap;
  }
  EXPECT_EQ(missing_volume(small_pump(0.1), 0.6), 0); // the bore is open
}

TEST(RollerTrack, RadiiFollowFromThoseThatAreStated) {
  const RollerTrack track = small_pump(0.08);
  EXPECT_NEAR(centreline_radius(track), 5.0 - 0.16 - 0.3, 1e-14);
  EXPECT_NEAR(pressing_radius(track), 5.0 - 0.32 - 0.08, 1e-14);
  EXPECT_NEAR(crank(track), 3.6, 1e-14);
  EXPECT_NEAR(1 / relative_radius(track), 1 - 1 / 4.6, 1e-14);
}

TEST(RollerTrack, ARollerIsReleasedOnTheTangentsAlone) {
  const RollerTrack track = small_pump(0.08);
  for (const double angle : {0.0, 1.0, pi}) {
    EXPECT_EQ(gap_at(track, angle).gap, 0.08);
    EXPECT_EQ(gap_at(track, angle).slope, 0);
  }
  const double released = release_angle(track);
  // The distance of the roller from a straight wall.
  EXPECT_NEAR(gap_at(track, pi + 0.2).gap, 0.08 + 3.6 * (1 - std::cos(0.2)), 1e-14);
  EXPECT_NEAR(gap_at(track, -0.2).gap, gap_at(track, pi + 0.2).gap, 1e-14);
  EXPECT_NEAR(gap_at(track, -0.2).slope, -gap_at(track, pi + 0.2).slope, 1e-14);
  EXPECT_LT(gap_at(track, pi + 0.999 * released).gap, 0.6);
  EXPECT_EQ(gap_at(track, pi + 1.001 * released).gap, 0.6);
  EXPECT_EQ(gap_at(track, pi + 3).gap, 0.6);
  // The greatest distance of what is squeezed, by its own extreme.
  EXPECT_GT(outer_reach(track), half_reach(track, 0.08));
  EXPECT_GE(outer_reach(track), centreline_radius(track) * released * (1 - 1e-12));
}

TEST(RollerTrack, TheFlatBoreIsAFilmOrACircleInTheLimits) {
  constexpr double a = 0.3;
  EXPECT_NEAR(flattened_area(a, 2 * a), pi * a * a, 1e-15);
  EXPECT_EQ(flattened_width(a, 2 * a), 0);
  EXPECT_NEAR(flattened_width(a, 0), pi * a, 1e-15);
  EXPECT_NEAR(flattened_hydraulic_diameter(a, 2 * a), 2 * a, 1e-15);
  EXPECT_NEAR(flattened_hydraulic_diameter(a, 1e-6), 2e-6, 1e-11);
  // The width is the derivative of the area.
  constexpr double h = 0.21, step = 1e-6;
  EXPECT_NEAR((flattened_area(a, h + step) - flattened_area(a, h - step)) / (2 * step), flattened_width(a, h),
              1e-9);
}

} // namespace
} // namespace undula::geometry
