// Scaled gaps of a profile: the factors hold at every radius, and nothing else moves.
#include "geometry/wave_pump/profile_scale.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "rom/base/error.hpp"
#include "simple_pump.hpp"

namespace undula::geometry {
namespace {

PumpProfile wave_pump() {
  return read_pump_profile(std::filesystem::path(UNDULA_SOURCE_DIR) / "data/profiles/wave_pump_profile.toml");
}

bool has_point(const ProfileCurve& curve, double r, double z) {
  for (const auto& x : curve.points)
    if (x == Point<2>(r, z)) return true;
  return false;
}

TEST(ProfileScale, MeasuresTheGapsOfTheWavePump) {
  const auto profile = wave_pump();
  // By hand from the table of points: wall minus half the thickness of the membrane.
  EXPECT_NEAR(vertical_clearance(profile, 1.3, true), 0.157 + 0.019 * (0.68 / 1.14) - 0.06, 1e-14);
  EXPECT_NEAR(vertical_clearance(profile, 1.874, true), 0.198 - 0.06, 1e-14); // not the recess at 0.359
  EXPECT_NEAR(vertical_clearance(profile, 1.89, false), 0.185 - 0.06, 1e-14); // not the chamber at -0.35
  EXPECT_NEAR(vertical_clearance(profile, 0.58, false), 0.148 - 0.0615 / 2, 1e-14);
  EXPECT_EQ(vertical_clearance(profile, 0.52, false), std::numeric_limits<double>::infinity());
  EXPECT_NEAR(rim_gap(profile), 0.054, 1e-14);
}

TEST(ProfileScale, FactorsOfOneChangeNoBit) {
  const auto profile = wave_pump();
  const auto same = scale_clearances(profile, 1, 1);
  EXPECT_EQ(same.file, profile.file);
  EXPECT_EQ(same.housing.points, profile.housing.points);
  EXPECT_EQ(same.housing.lines, profile.housing.lines);
  EXPECT_EQ(same.stator.points, profile.stator.points);
  EXPECT_EQ(same.stator.lines, profile.stator.lines);
  EXPECT_EQ(same.membrane.outer_radius, profile.membrane.outer_radius);
  EXPECT_EQ(same.membrane.thickness.points, profile.membrane.thickness.points);
  EXPECT_EQ(same.magnet.points, profile.magnet.points);
}

TEST(ProfileScale, ClearancesFollowTheFactorAtEveryRadius) {
  const auto profile = wave_pump();
  for (const double scale : {0.5, 0.9, 1.1, 1.5, 2.0}) {
    const auto scaled = scale_clearances(profile, scale, 1);
    // Up to the corner of the stator above (1.874) and to the clamp radius below.
    for (int i = 0; i <= 200; ++i) {
      const double r = 0.5 + (1.874 - 0.5) * i / 200;
      EXPECT_NEAR(vertical_clearance(scaled, r, true), scale * vertical_clearance(profile, r, true), 1e-12)
          << scale << " at " << r;
    }
    for (int i = 0; i <= 200; ++i) {
      const double r = 0.55 + (1.89 - 0.55) * i / 200;
      EXPECT_NEAR(vertical_clearance(scaled, r, false), scale * vertical_clearance(profile, r, false), 1e-12)
          << scale << " at " << r;
    }
    EXPECT_EQ(rim_gap(scaled), rim_gap(profile));
  }
}

TEST(ProfileScale, TheNoseKeepsItsShape) {
  const auto profile = wave_pump();
  const auto scaled = scale_clearances(profile, 1.4, 1);
  const double shift = 0.4 * vertical_clearance(profile, 0.5, true);
  const auto last = profile.stator.points.size() - 1, scaled_last = scaled.stator.points.size() - 1;
  for (std::size_t back = 0; back < 5; ++back) { // the points of r < 0.5
    const auto& before = profile.stator.points[last - back];
    const auto& after = scaled.stator.points[scaled_last - back];
    EXPECT_EQ(after.x(), before.x());
    EXPECT_NEAR(after.y(), before.y() + shift, 1e-14);
  }
}

TEST(ProfileScale, WallsElsewhereStay) {
  const auto profile = wave_pump();
  const auto scaled = scale_clearances(profile, 1.3, 1);
  for (std::size_t i = 0; i <= 13; ++i) // inlet, roof, side wall, lower chamber up to (1.89, -0.35)
    EXPECT_EQ(scaled.housing.points[i], profile.housing.points[i]);
  EXPECT_EQ(scaled.housing.points.back(), profile.housing.points.back()); // the outlet's rim
  for (std::size_t i = 0; i <= 5; ++i) // top and side of the stator, and the recess at (1.874, 0.359)
    EXPECT_EQ(scaled.stator.points[i], profile.stator.points[i]);
  EXPECT_EQ(scaled.magnet.points, profile.magnet.points);
  EXPECT_EQ(scaled.membrane.thickness.points, profile.membrane.thickness.points);
  // The corners at the ends of the flanges move by 0.3 times their clearance.
  const auto& corner = scaled.stator.points[6];
  EXPECT_EQ(corner.x(), 1.874);
  EXPECT_NEAR(corner.y(), 0.198 + 0.3 * 0.138, 1e-14);
  EXPECT_NEAR(scaled.housing.points[14].y(), -0.185 - 0.3 * 0.125, 1e-14);
  // Lines of the file go with their points: an added point has the line of the one before it.
  ASSERT_EQ(scaled.stator.lines.size(), scaled.stator.points.size());
  EXPECT_EQ(scaled.stator.lines[6], profile.stator.lines[6]);
  EXPECT_EQ(scaled.stator.lines.back(), profile.stator.lines.back());
}

TEST(ProfileScale, TheRimGapFollowsItsFactorAndTheFlangesStay) {
  const auto profile = wave_pump();
  for (const double scale : {0.5, 0.8, 1.2, 2.0}) {
    const auto scaled = scale_clearances(profile, 1, scale);
    EXPECT_NEAR(rim_gap(scaled), scale * 0.054, 1e-14);
    EXPECT_NEAR(scaled.membrane.outer_radius, 2.5 - scale * 0.054, 1e-14);
    EXPECT_EQ(scaled.membrane.thickness.points.back(), Point<2>(scaled.membrane.outer_radius, 0.12));
    EXPECT_EQ(scaled.housing.points, profile.housing.points);
    EXPECT_EQ(scaled.stator.points, profile.stator.points);
  }
}

TEST(ProfileScale, TheNarrowestPartOfALeaningRimGapCounts) {
  auto profile = simple_pump();
  profile.housing.points[3] = {3.5, -0.5}; // side wall from (3, 2) to (3.5, -0.5)
  const double at_the_upper_edge = 3 + 0.5 * 1.9 / 2.5 - 2.9;
  EXPECT_NEAR(rim_gap(profile), at_the_upper_edge, 1e-14);
  EXPECT_NEAR(rim_gap(scale_clearances(profile, 1, 0.7)), 0.7 * at_the_upper_edge, 1e-14);
}

TEST(ProfileScale, BothFactorsWorkTogetherOverTheStatedRange) {
  const auto profile = wave_pump();
  for (double clearance = 0.5; clearance <= 2; clearance += 0.125)
    for (const double rim : {0.5, 1.0, 2.0}) {
      const auto scaled = scale_clearances(profile, clearance, rim);
      EXPECT_NO_THROW(check_pump_profile(scaled));
      EXPECT_NEAR(vertical_clearance(scaled, 1.2, true), clearance * vertical_clearance(profile, 1.2, true),
                  1e-12);
      EXPECT_NEAR(rim_gap(scaled), rim * 0.054, 1e-14);
    }
}

TEST(ProfileScale, AFlangeThatGoesOnBeyondTheClampGetsAStep) {
  const auto profile = simple_pump(); // its lower flange is the whole floor, r from 0.5 to 3
  const auto scaled = scale_clearances(profile, 1.5, 1);
  EXPECT_TRUE(has_point(scaled.housing, 3, -0.5));
  EXPECT_TRUE(has_point(scaled.housing, 2, -0.5)); // foot of the step
  EXPECT_TRUE(has_point(scaled.housing, 0.5, -2));
  EXPECT_NEAR(vertical_clearance(scaled, 2 - 1e-6, false), 0.6, 1e-12);
  EXPECT_NEAR(vertical_clearance(scaled, 2 + 1e-6, false), 0.4, 1e-12);
  EXPECT_NEAR(vertical_clearance(scaled, 0.6, false), 0.6, 1e-12);
  // Inside of the tip, floor and nose move as a whole.
  EXPECT_NEAR(scaled.housing.points[scaled.housing.points.size() - 2].y(), -0.7, 1e-14);
  EXPECT_NEAR(scaled.stator.points.back().y(), 0.7, 1e-14);
  EXPECT_EQ(scaled.stator.points.front(), profile.stator.points.front());
}

TEST(ProfileScale, RefusesWhatTheWallsDoNotBear) {
  const auto profile = wave_pump();
  EXPECT_THROW(scale_clearances(profile, 0, 1), InputError);
  EXPECT_THROW(scale_clearances(profile, 1, -1), InputError);
  EXPECT_THROW(scale_clearances(profile, std::nan(""), 1), InputError);
  EXPECT_THROW(scale_clearances(profile, 10, 1), InputError); // the lower flange would fall below the outlet
  // The corner at (1.874, 0.198) meets the recess behind it, (1.874, 0.359), at 1 + 0.161 / 0.138.
  EXPECT_NO_THROW(scale_clearances(profile, 2.16, 1));
  EXPECT_THROW(scale_clearances(profile, 2.17, 1), InputError);
  try {
    scale_clearances(profile, 1, 12); // the rim would lie inside of the clamp radius
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("rim_gap_scale = 12"), std::string::npos) << error.what();
  }
}

} // namespace
} // namespace undula::geometry
