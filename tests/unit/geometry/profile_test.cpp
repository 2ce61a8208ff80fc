#include "geometry/wave_pump/profile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>
#include <string>

#include "geometry/wave_pump/membrane_outline.hpp"
#include "rom/base/error.hpp"
#include "simple_pump.hpp"

namespace undula::geometry {
namespace {

const std::filesystem::path source = UNDULA_SOURCE_DIR;
const std::filesystem::path bad = source / "tests/data/bad/profiles";

std::string message_of(const std::filesystem::path& file) {
  try {
    read_pump_profile(file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

double area(const std::vector<Point<2>>& polygon) {
  double sum = 0;
  for (std::size_t i = 0, n = polygon.size(); i < n; ++i) {
    const auto& a = polygon[i];
    const auto& b = polygon[(i + 1) % n];
    sum += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  return sum;
}

TEST(Profile, ReadsTheWavePump) {
  const auto profile = read_pump_profile(source / "data/profiles/wave_pump_profile.toml");
  ASSERT_EQ(profile.housing.points.size(), 20u);
  EXPECT_EQ(profile.housing.points.front(), Point<2>(0.6, 3.79));
  EXPECT_EQ(profile.housing.points.back(), Point<2>(0.55, -0.9));
  ASSERT_EQ(profile.stator.points.size(), 15u);
  EXPECT_EQ(profile.stator.points.back(), Point<2>(0, 0.034));
  EXPECT_EQ(profile.membrane.inner_radius, 0.5);
  EXPECT_EQ(profile.membrane.outer_radius, 2.446);
  EXPECT_EQ(profile.membrane.clamp_radius, 1.89);
  EXPECT_EQ(profile.membrane.mid_plane, 0.0);
  EXPECT_EQ(profile.magnet.points.size(), 8u);
  EXPECT_EQ(profile.magnet.points[3], Point<2>(2.19, 1.6646));
}

TEST(Profile, InterpolatesThickness) {
  const auto profile = read_pump_profile(source / "data/profiles/wave_pump_profile.toml");
  EXPECT_DOUBLE_EQ(membrane_thickness(profile.membrane, 0.5), 0.055);
  EXPECT_DOUBLE_EQ(membrane_thickness(profile.membrane, 0.9), 0.0875);
  EXPECT_DOUBLE_EQ(membrane_thickness(profile.membrane, 2.0), 0.12);
  EXPECT_DOUBLE_EQ(membrane_thickness(profile.membrane, 9.0), 0.12);
}

TEST(Profile, OutlinesEncloseTheExactAreas) {
  const auto profile = simple_pump();
  const auto outline = fluid_outline(profile);
  EXPECT_NEAR(area(outline.points), 0.5 * 1 + 3 * 2.5 - 2 * 1 + 0.5 * 1.5, 1e-14);
  const auto membrane = membrane_outline(profile.membrane).points;
  EXPECT_NEAR(area(membrane), 2.3 * 0.2, 1e-14);
  EXPECT_EQ(membrane.size(), 6u); // two ends and the clamp radius on either side

  std::array<double, 5> length{};
  for (std::size_t i = 0; i < outline.points.size(); ++i)
    length[outline.curves[i]] += (outline.points[(i + 1) % outline.points.size()] - outline.points[i]).norm();
  EXPECT_DOUBLE_EQ(length[FluidOutline::inlet], 0.5);
  EXPECT_DOUBLE_EQ(length[FluidOutline::outlet], 0.5);
  EXPECT_DOUBLE_EQ(length[FluidOutline::axis], 1.5 + 2.5);
  EXPECT_DOUBLE_EQ(length[FluidOutline::stator], 2 + 1 + 2);
  EXPECT_DOUBLE_EQ(length[FluidOutline::housing], 1 + 2.5 + 2.5 + 2.5 + 1.5);
}

// A corner of angle a and radius r loses r^2 (cot(a / 2) - (pi - a) / 2) by its arc, and less by chords.
TEST(Profile, RoundsTheCornersOfTheMembrane) {
  auto profile = read_pump_profile(source / "data/profiles/wave_pump_profile.toml");
  auto& membrane = profile.membrane;
  const double sharp = area(membrane_outline(membrane).points);
  membrane.tip_radius = 0.02;
  membrane.rim_radius = 0.05;
  EXPECT_NO_THROW(check_pump_profile(profile));
  const auto rounded = membrane_outline(membrane);
  const double slope = std::atan(0.5 * (0.12 - 0.055) / 0.8), a = std::numbers::pi / 2 + slope;
  const auto lost = [](double angle, double r) {
    return r * r * (1 / std::tan(angle / 2) - (std::numbers::pi - angle) / 2);
  };
  const double arcs = 2 * lost(a, 0.02) + 2 * lost(std::numbers::pi / 2, 0.05);
  EXPECT_GT(sharp - area(rounded.points), arcs);
  EXPECT_LT(sharp - area(rounded.points), 1.15 * arcs);
  double inner = 10, outer = 0;
  for (const auto& x : rounded.points) {
    inner = std::min(inner, x.x());
    outer = std::max(outer, x.x());
  }
  EXPECT_EQ(inner, membrane.inner_radius);
  EXPECT_EQ(outer, membrane.outer_radius);
  for (const int k : rounded.clamp) EXPECT_EQ(rounded.points[k].x(), membrane.clamp_radius);
  EXPECT_LT(rounded.points[rounded.clamp[0]].y(), rounded.points[rounded.clamp[1]].y());

  membrane.tip_radius = largest_tip_radius(membrane);
  EXPECT_NO_THROW(check_pump_profile(profile));
  membrane.tip_radius *= 1.01;
  EXPECT_THROW(check_pump_profile(profile), InputError);
  membrane.tip_radius = -0.01;
  EXPECT_THROW(check_pump_profile(profile), InputError);
}

TEST(Profile, AcceptsTheBaseOfTheBadOnes) { EXPECT_NO_THROW(check_pump_profile(simple_pump())); }

TEST(Profile, DecidesContactExactly) {
  auto profile = simple_pump();
  profile.membrane.thickness.points = {{0.6, 0.2}, {3.0, 0.2}};
  profile.membrane.outer_radius = 3.0; // touches the side wall
  EXPECT_THROW(check_pump_profile(profile), InputError);
  const double inside = std::nextafter(3.0, 0.0); // one rounding unit of clearance
  profile.membrane.thickness.points[1].x() = inside;
  profile.membrane.outer_radius = inside;
  EXPECT_NO_THROW(check_pump_profile(profile));
}

TEST(Profile, MissingFileIsNamed) {
  const auto message = message_of(bad / "no_such_file.toml");
  EXPECT_NE(message.find("no_such_file.toml"), std::string::npos) << message;
}

struct BadProfile {
  std::string file;
  int line; ///< named in the message; 0 where a whole table is missing
  std::string says;
};

const BadProfile bad_profiles[] = {
    {"syntax", 5, "not valid TOML"},
    {"missing_table", 0, "no [magnet]"},
    {"missing_key", 8, "no 'membrane.clamp_radius'"},
    {"unknown_key", 11, "membrane.clamp_radus"},
    {"unknown_table", 18, "casing"},
    {"table_is_number", 2, "'stator' must be a table"},
    {"not_a_number", 10, "'membrane.outer_radius' needs numbers"},
    {"not_finite", 13, "'membrane.mid_plane' needs numbers"},
    {"not_a_list", 16, "'magnet.polygon' must be a list of points"},
    {"not_a_pair", 6, "not a pair"},
    {"too_few_points", 3, "too few points"},
    {"magnet_of_two_points", 16, "too few points"},
    {"repeated_point", 3, "repeats a point"},
    {"negative_radius", 16, "negative radius"},
    {"housing_on_axis", 3, "touches the axis"},
    {"stator_off_axis", 6, "does not end on the axis"},
    {"upside_down", 6, "out of order along the axis"},
    {"housing_crosses_itself", 3, "cross or touch"},
    {"housing_folds_back", 3, "cross or touch"},
    {"stator_crosses_itself", 6, "cross or touch"},
    {"stator_crosses_housing", 6, "cross or touch"},
    {"stator_touches_housing", 6, "cross or touch"},
    {"thickness_zero", 12, "no thickness"},
    {"thickness_negative", 12, "no thickness"},
    {"thickness_not_ascending", 12, "do not ascend"},
    {"thickness_too_short", 12, "does not span"},
    {"clamp_outside_membrane", 8, "outside of the membrane"},
    {"membrane_through_housing", 8, "crosses or touches the housing"},
    {"membrane_touches_flange", 8, "crosses or touches the housing"},
    {"membrane_below_housing", 8, "outside of the fluid domain"},
    {"magnet_in_stator", 16, "outside of the fluid domain"},
    {"magnet_crosses_itself", 16, "crosses or touches itself"},
    {"magnet_in_membrane", 16, "overlap"},
    {"magnet_touches_membrane", 8, "crosses or touches the magnet"},
    {"spike", 6, "too short to be meshed"},
    {"leaf_of_atoms", 8, "too short to be meshed"},
    {"far_away", 3, "too far away"},
    {"negative_viscosity", 19, "'materials.fluid.viscosity' makes no sense"},
    {"unknown_material", 19, "materials.fluid.densty"},
    {"stroke_in_words", 19, "'operating_point.stroke' needs numbers"},
};

TEST(Profile, EveryBadProfileIsRefusedWithItsLine) {
  std::set<std::string> tested;
  for (const auto& [name, line, says] : bad_profiles) {
    const auto file = bad / (name + ".toml");
    const auto message = message_of(file);
    EXPECT_NE(message.find(says), std::string::npos) << name << ": " << message;
    const auto where = file.string() + (line > 0 ? ":" + std::to_string(line) : "");
    EXPECT_TRUE(message.ends_with(where)) << name << ": " << message;
    tested.insert(file.filename().string());
  }
  for (const auto& entry : std::filesystem::directory_iterator(bad))
    EXPECT_TRUE(tested.contains(entry.path().filename().string())) << entry.path();
}

} // namespace
} // namespace undula::geometry
