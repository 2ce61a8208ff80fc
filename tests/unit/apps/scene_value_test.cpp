// Tolerances beside the numbers of a scene, and single numbers read and set by their key.
#include "fom/scene/scene_value.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "apps/apps.hpp"
#include "fom/machines/wave_pump/pump_problem.hpp"
#include "fom/scene/scene_file.hpp"
#include "fom/scene/scene_table.hpp"
#include "fom/scene/scene_tolerance.hpp"
#include "geometry/wave_pump/profile_scale.hpp"
#include "rom/base/error.hpp"
#include "tests/unit/apps/run_undula.hpp"

namespace undula::apps {
namespace {

const std::string shipped = UNDULA_SOURCE_DIR "/data/scenes/wave_pump_fixed.toml";
const std::string stroke = "operating_point.stroke_mm";

Scene with(const std::vector<std::string>& overrides) { return read_scene(shipped, overrides); }

std::string message_of(const std::vector<std::string>& overrides) {
  try {
    with(overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// The shipped scene with one line of its text replaced.
std::string edited(const std::string& from, const std::string& to) {
  std::string text = text_of(shipped);
  text.replace(text.find(from), from.size(), to);
  return text;
}

TEST(SceneTolerance, AnInlineTableStatesValueAndTolerance) {
  const Scene scene = with({stroke + "={ value = 0.5, tolerance = 0.01 }"});
  EXPECT_DOUBLE_EQ(scene.operating_point.stroke, 0.05);
  ASSERT_EQ(scene.tolerances.size(), 1u);
  EXPECT_EQ(scene.tolerances[0].key, stroke);
  EXPECT_EQ(scene.tolerances[0].tolerance, 0.01); // in mm, as the key
  EXPECT_TRUE(with({}).tolerances.empty());
}

TEST(SceneTolerance, ANumberKeepsTheToleranceOfTheFileAndATableReplacesIt) {
  const std::string text = edited("stroke_mm = 0.53", "stroke_mm = { value = 0.53, tolerance = 0.01 }");
  const std::filesystem::path base = UNDULA_SOURCE_DIR "/data/scenes";
  const auto parsed = [&](const std::vector<std::string>& overrides) {
    return parse_scene(text, "edited", base, overrides);
  };
  const Scene kept = parsed({stroke + "=0.63"});
  EXPECT_DOUBLE_EQ(kept.operating_point.stroke, 0.063);
  EXPECT_EQ(tolerance_of(kept, stroke), 0.01);
  EXPECT_EQ(tolerance_of(parsed({stroke + "={ value = 0.63, tolerance = 0.02 }"}), stroke), 0.02);
  EXPECT_TRUE(parsed({stroke + "={ value = 0.63 }"}).tolerances.empty());
  EXPECT_TRUE(parsed({stroke + "={ value = 0.63, tolerance = 0 }"}).tolerances.empty());
  // The stroke must stay >= 0 with the tolerance of the file.
  EXPECT_NO_THROW(parsed({stroke + "=0.01"}));
  EXPECT_THROW(parsed({stroke + "=0.009"}), InputError);
}

TEST(SceneTolerance, NarrowsToWhatTheRangeOfTheKeyAllows) {
  const std::string poisson = "membrane.poisson"; // in (-1, 0.5), both ends refused
  Scene scene = with_value(with({stroke + "={ value = 0.5, tolerance = 0.2 }"}), stroke, 0.05);
  scene = with_value(scene, poisson, 0.49);
  set_tolerance(scene, poisson, 0.3);
  set_tolerance(scene, "fluid.density_g_per_cm3", 0.1);
  for (const std::string& key : {stroke, poisson, std::string("fluid.density_g_per_cm3")}) {
    narrow_tolerance(scene, key);
  }
  EXPECT_DOUBLE_EQ(tolerance_of(scene, stroke), 0.05);
  EXPECT_NEAR(tolerance_of(scene, poisson), 0.01, 1e-7);
  EXPECT_LT(tolerance_of(scene, poisson), 0.01);
  EXPECT_EQ(tolerance_of(scene, "fluid.density_g_per_cm3"), 0.1);
  EXPECT_NO_THROW(parse_scene(scene_to_toml(scene), "narrowed", UNDULA_SOURCE_DIR "/data/scenes"));
}

TEST(SceneTolerance, TheyAreKeptInTheOrderOfTheTable) {
  const Scene scene =
      with({"mesh.growth={ value = 0.3, tolerance = 0.1 }", stroke + "={value=0.5,tolerance=0.1}",
            "fluid.viscosity_poise={ value = 0.035, tolerance = 0.001 }"});
  ASSERT_EQ(scene.tolerances.size(), 3u);
  EXPECT_EQ(scene.tolerances[0].key, "fluid.viscosity_poise");
  EXPECT_EQ(scene.tolerances[1].key, stroke);
  EXPECT_EQ(scene.tolerances[2].key, "mesh.growth");
}

TEST(SceneTolerance, TheyReadBackBitForBitAndDoNotChangeTheHash) {
  const Scene bare = with({"operating_point.head_mmHg=52.7182818"});
  const Scene scene =
      with({"operating_point.head_mmHg={ value = 52.7182818, tolerance = 0.31415926535897931 }",
            "membrane.damping_time_s={ value = 1.1e-4, tolerance = 1.1e-4 }"});
  const Scene again = parse_scene(scene_to_toml(scene), "recorded", "/");
  EXPECT_EQ(again.operating_point.head, scene.operating_point.head);
  EXPECT_EQ(tolerance_of(again, "operating_point.head_mmHg"), 0.31415926535897931);
  EXPECT_EQ(tolerance_of(again, "membrane.damping_time_s"), 1.1e-4);
  EXPECT_EQ(scene_to_toml(again), scene_to_toml(scene));
  EXPECT_EQ(scene_hash(with({"membrane.damping_time_s=1.1e-4", "operating_point.head_mmHg=52.7182818"})),
            scene_hash(scene));
  EXPECT_NE(scene_hash(bare), scene_hash(scene)); // the other damping time does count
}

TEST(SceneTolerance, EveryRealKeyTakesOneAndNoOtherKeyDoes) {
  for (const SceneKey& key : scene_table()) {
    Scene scene = with({});
    if (!key.applies_to(scene)) continue; // refused before its value is read
    if (const auto* real = std::get_if<RealKey>(&key.value)) {
      const double middle = real->field(scene) / real->cgs_per_unit;
      const auto stated = [&](double tolerance) {
        return key.path + "={ value = " + shortest_number(middle) +
               ", tolerance = " + shortest_number(tolerance) + " }";
      };
      const std::string refused = message_of({stated(real->allowed.high - real->allowed.low + 1)});
      EXPECT_NE(refused.find("leaves its range within its tolerance"), std::string::npos)
          << key.path << ": " << refused;
      for (const double bad : {-1.0, std::nan(""), HUGE_VAL}) {
        EXPECT_NE(message_of({stated(bad)}).find("the tolerance of key"), std::string::npos) << key.path;
      }
    } else if (!std::holds_alternative<TextKey>(key.value)) { // --set takes any text as a name
      const std::string refused = message_of({key.path + "={ value = 1, tolerance = 0 }"});
      EXPECT_FALSE(refused.empty()) << key.path;
    }
  }
}

TEST(SceneTolerance, AWrongOneInAFileIsNamedWithItsLine) {
  const std::string text = edited("head_mmHg = 50.0", "head_mmHg = { value = 50.0, tolerance = -2.0 }");
  const auto line =
      std::count(text.begin(), text.begin() + static_cast<long>(text.find("tolerance = -2.0")), '\n');
  try {
    parse_scene(text, "edited", UNDULA_SOURCE_DIR "/data/scenes");
    FAIL();
  } catch (const InputError& error) {
    const std::string expected = "where:   edited:" + std::to_string(line + 1);
    EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
  }
}

TEST(SceneProfile, HasTheGapsScaledAsTheSceneSays) {
  const auto profile = scene_profile(with({}));
  const auto scaled = scene_profile(
      with({"geometry.clearance_scale=1.5", "geometry.rim_gap_scale={value=0.8,tolerance=0.1}"}));
  EXPECT_NEAR(vertical_clearance(scaled, 1.0, true), 1.5 * vertical_clearance(profile, 1.0, true), 1e-12);
  EXPECT_NEAR(rim_gap(scaled), 0.8 * 0.054, 1e-12);
}

TEST(SceneValue, ReadsInTheUnitOfTheKey) {
  const Scene scene = with({});
  EXPECT_EQ(surface_value(scene, stroke), 0.53);
  EXPECT_EQ(surface_value(scene, "operating_point.head_mmHg"), 50);
  EXPECT_EQ(surface_value(scene, "membrane.young_dyn_per_cm2"), 1.686e7);
}

TEST(SceneValue, SetsWhatAnOverrideSets) {
  const Scene scene = with({stroke + "={ value = 0.53, tolerance = 0.01 }"});
  for (const double value : {0.1, 0.63, 0.7182818284590452}) {
    const Scene set = with_value(scene, stroke, value);
    EXPECT_EQ(set.operating_point.stroke,
              with({stroke + "=" + shortest_number(value)}).operating_point.stroke);
    EXPECT_DOUBLE_EQ(surface_value(set, stroke), value); // two decimals may give the same cgs number
    EXPECT_EQ(tolerance_of(set, stroke), 0.01);
    EXPECT_EQ(set.operating_point.head, scene.operating_point.head);
  }
  EXPECT_EQ(scene.operating_point.stroke, 0.53 * 0.1);
}

TEST(SceneValue, EveryRealKeyReadsBackWhatWasSet) {
  const Scene scene = with({});
  for (const SceneKey& key : scene_table()) {
    if (!key.applies_to(scene)) continue; // what a scene has not, has no value
    if (!std::holds_alternative<RealKey>(key.value)) {
      EXPECT_THROW(surface_value(scene, key.path), InputError) << key.path;
      EXPECT_THROW(with_value(scene, key.path, 1), InputError) << key.path;
      continue;
    }
    const double value = surface_value(scene, key.path);
    EXPECT_EQ(scene_to_toml(with_value(scene, key.path, value)), scene_to_toml(scene)) << key.path;
    EXPECT_THROW(with_value(scene, key.path, std::get<RealKey>(key.value).allowed.high + 1e15), InputError);
    EXPECT_THROW(with_value(scene, key.path, std::nan("")), InputError);
  }
}

TEST(SceneValue, RefusesWithTheKeyThatWasMeant) {
  const Scene scene = with({});
  const auto refusal = [&](const char* key) {
    try {
      with_value(scene, key, 1);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refusal("operating_point.stroke_cm").find("\"operating_point.stroke_mm\""), std::string::npos);
  EXPECT_NE(refusal("operating_point.strok_mm").find("\"operating_point.stroke_mm\""), std::string::npos);
  EXPECT_NE(refusal("time.periods").find("\"time.ramp_periods\""), std::string::npos);
  EXPECT_NE(refusal("time.periods").find("no real number"), std::string::npos);
  // A contradiction between keys: a smooth start longer than the run.
  EXPECT_THROW(with_value(scene, "time.ramp_periods", 11), InputError);
}

} // namespace
} // namespace undula::apps
