// Heights, areas and passages that the thin-gap level takes from a profile.
#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>

#include "fom/thin_gap/layout.hpp"
#include "geometry/wave_pump/profile_scale.hpp"
#include "geometry/wave_pump/pump.hpp"
#include "rom/base/error.hpp"
#include "tests/unit/geometry/simple_pump.hpp"

namespace undula::fom {
namespace {

constexpr double pi = std::numbers::pi;

PumpProfile wave_pump() {
  return read_pump_profile(std::filesystem::path(UNDULA_SOURCE_DIR) / "data/profiles/wave_pump_profile.toml");
}
ThinGapLayout layout_of(const PumpProfile& profile, int cells, double channel_size = 0.12) {
  const auto background = pump_background(profile, {2.0, channel_size, 0.04, 0.5});
  return thin_gap_layout(profile, background, profile.membrane.clamp_radius, cells);
}

/// Radius at which a linear function has its mean over the ring of a node.
double mean_radius(const ThinGapLayout& layout, int node) {
  const double low = face_radius(layout, node), high = face_radius(layout, node + 1);
  return 2.0 / 3 * (high * high * high - low * low * low) / (high * high - low * low);
}

TEST(ThinGapLayout, HasTheHeightsOfTheWavePump) {
  const auto layout = layout_of(wave_pump(), 96);
  ASSERT_EQ(layout.radius.size(), 97u);
  EXPECT_EQ(layout.radius.front(), 0.5);
  EXPECT_NEAR(layout.radius.back(), 2.446, 1e-14);
  EXPECT_NEAR(layout.radius[layout.clamp], 1.89, 1e-14);
  // The stator ends at r = 1.93.
  EXPECT_NEAR(layout.radius[layout.channel], 1.93, 0.55 * layout.step);
  ASSERT_EQ(layout.upper_height.size(), static_cast<std::size_t>(layout.channel) + 1);
  int upper_checked = 0, lower_checked = 0;
  double area = 0;
  for (std::size_t i = 0; i < layout.radius.size(); ++i) {
    const int node = static_cast<int>(i);
    const double low = face_radius(layout, node), high = face_radius(layout, node + 1);
    const double r = mean_radius(layout, node);
    area += node_area(layout, node);
    // By hand from the table of points, where wall and thickness have no corner within the node's ring.
    const double half = (0.055 + 0.065 * (r - 0.5) / 0.8) / 2;
    if (low > 0.62 && high < 1.3) {
      EXPECT_NEAR(layout.upper_height[i], 0.157 + 0.019 * (r - 0.62) / 1.14 - half, 2e-6) << r;
      ++upper_checked;
    }
    if (low > 0.58 && high < 1.3) {
      EXPECT_NEAR(layout.lower_height[i], 0.148 + 0.017 * (r - 0.58) / 1.2 - half, 2e-6) << r;
      ++lower_checked;
    }
    if (low > 1.3 && high < 1.76) {
      EXPECT_NEAR(layout.upper_height[i], 0.157 + 0.019 * (r - 0.62) / 1.14 - 0.06, 2e-6) << r;
      EXPECT_NEAR(layout.lower_height[i], 0.148 + 0.017 * (r - 0.58) / 1.2 - 0.06, 2e-6) << r;
    }
    if (low > 1.9 && high < 2.43) {
      EXPECT_NEAR(layout.lower_height[i], 0.35 - 0.06, 1e-12) << r;
    }
    if (node < layout.lip) {
      EXPECT_NEAR(layout.lower_height[i], 0.9 - half, 1e-3); // the outlet below
    }
    EXPECT_NEAR(layout.thickness[i],
                layout.radius[i] < 1.3 ? 0.055 + 0.065 * (layout.radius[i] - 0.5) / 0.8 : 0.12, 1e-12);
  }
  EXPECT_GT(upper_checked, 10);
  EXPECT_GT(lower_checked, 10);
  EXPECT_GT(layout.lip, 0);
  EXPECT_GT(layout.radius[layout.lip] + layout.step, 0.55);
  EXPECT_LT(layout.radius[layout.lip - 1], 0.55);
  EXPECT_NEAR(area, pi * (2.446 * 2.446 - 0.25), 1e-12);
  const double from = face_radius(layout, layout.channel);
  EXPECT_NEAR(layout.holder_area, pi * (2.446 * 2.446 - from * from), 1e-12);
  EXPECT_NEAR(layout.rim.area, pi * (2.5 * 2.5 - 2.446 * 2.446), 1e-12);
  EXPECT_NEAR(layout.rim.inertance, 0.12 / layout.rim.area, 1e-12);
  EXPECT_NEAR(layout.rim.resistance, 12 / (0.054 * 0.054) * 0.12 / layout.rim.area, 1e-6);
  // A straight bore of radius 0.55 from the flange (0.15) to the outlet (0.9), and what bends into it.
  EXPECT_GT(layout.outlet.inertance, 0.6 * 0.75 / (pi * 0.55 * 0.55));
  EXPECT_LT(layout.outlet.inertance, 1.6 * 0.75 / (pi * 0.55 * 0.55));
  EXPECT_LE(layout.outlet.area, pi * 0.55 * 0.55 * 1.01);
  EXPECT_LE(layout.inlet.area, pi * 0.6 * 0.6 * 1.01); // the inlet's bore, or what is narrower
}

TEST(ThinGapLayout, HeightsScaleWithTheClearances) {
  const auto profile = wave_pump();
  const auto rest = layout_of(profile, 64);
  for (const double scale : {0.9, 1.1}) {
    const auto scaled = layout_of(scale_clearances(profile, scale, 1), 64);
    ASSERT_EQ(scaled.radius, rest.radius);
    EXPECT_EQ(scaled.channel, rest.channel);
    int checked = 0;
    for (int node = rest.lip; face_radius(rest, node + 1) < 1.874; ++node, ++checked) {
      EXPECT_NEAR(scaled.upper_height[node], scale * rest.upper_height[node], 1e-12);
      EXPECT_NEAR(scaled.lower_height[node], scale * rest.lower_height[node], 1e-12);
    }
    EXPECT_GT(checked, 30);
    EXPECT_EQ(scaled.rim.area, rest.rim.area);
  }
  const auto wider = layout_of(scale_clearances(profile, 1, 1.2), 64);
  EXPECT_GT(wider.rim.area, 1.15 * rest.rim.area);
  EXPECT_LT(wider.rim.resistance, rest.rim.resistance / 1.5);
}

TEST(ThinGapLayout, IsExactForAPumpOfRightAngles) {
  const auto profile = simple_pump();
  const auto layout = layout_of(profile, 46, 0.2);
  for (const double height : layout.upper_height) EXPECT_NEAR(height, 0.4, 1e-12);
  for (const double height : layout.lower_height) EXPECT_NEAR(height, 0.4, 1e-12);
  EXPECT_EQ(layout.lip, 0);                // the bore is narrower than the tip
  EXPECT_EQ(layout.channel, layout.clamp); // both at r = 2
  EXPECT_NEAR(layout.rim.area, pi * (9 - 2.9 * 2.9), 1e-12);
}

TEST(ThinGapLayout, RefusesAProfileWithoutItsParts) {
  auto profile = simple_pump();
  profile.membrane.clamp_radius = 2.3; // beyond the end of the flange above
  const auto background = pump_background(profile, {2.0, 0.2, 0.05, 0.5});
  EXPECT_THROW(thin_gap_layout(profile, background, profile.membrane.clamp_radius, 46), InputError);
  EXPECT_THROW(thin_gap_layout(profile, background, 0.65, 46), InputError); // no room for the free part
}

} // namespace
} // namespace undula::fom
