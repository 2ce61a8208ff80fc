// Scenes: units, defaults, round trip, hash, documentation from the table.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "apps/apps.hpp"
#include "fom/scene/scene_file.hpp"
#include "fom/scene/scene_key_search.hpp"
#include "fom/scene/scene_reference.hpp"
#include "rom/base/error.hpp"
#include "tests/unit/apps/run_undula.hpp"

namespace undula::apps {
namespace {

const std::string shipped = UNDULA_SOURCE_DIR "/data/scenes/wave_pump_fixed.toml";

Scene with(const std::vector<std::string>& overrides) { return read_scene(shipped, overrides); }

TEST(Scene, TheShippedSceneIsThePumpInCgsUnits) {
  const Scene scene = read_scene(shipped);
  EXPECT_EQ(scene.name, "wave_pump_fixed");
  EXPECT_EQ(scene.space, Space::axisymmetric);
  EXPECT_EQ(scene.flow, FlowModel::navier_stokes);
  EXPECT_EQ(scene.profile.string(), UNDULA_SOURCE_DIR "/data/profiles/wave_pump_profile.toml");
  EXPECT_DOUBLE_EQ(scene.operating_point.frequency, 120);
  EXPECT_DOUBLE_EQ(scene.operating_point.stroke, 0.053);
  EXPECT_DOUBLE_EQ(scene.operating_point.head, 50 * 1333.22387415);
  EXPECT_DOUBLE_EQ(scene.fluid.viscosity, 0.035);
  EXPECT_DOUBLE_EQ(scene.membrane.young, 1.686e7);
  EXPECT_DOUBLE_EQ(scene.membrane.damping_time, 1e-4);
  EXPECT_DOUBLE_EQ(scene.mesh.channel_size, 0.08);
  EXPECT_EQ(scene.time.scheme, TimeScheme::bdf2);
  EXPECT_EQ(scene.time.steps_per_period, 96);
  EXPECT_DOUBLE_EQ(scene.training.stroke_high, 0.08);
  EXPECT_DOUBLE_EQ(scene.training.head_high, 70 * 1333.22387415);
}

TEST(Scene, WhatIsLeftOutHasTheDefaultOfTheTable) {
  const Scene scene = read_scene(shipped);
  EXPECT_DOUBLE_EQ(scene.stabilisation.nitsche_viscous, 20);
  EXPECT_DOUBLE_EQ(scene.stabilisation.reference_velocity, 100);
  EXPECT_DOUBLE_EQ(scene.stabilisation.reference_time, 2e-4);
  EXPECT_EQ(scene.inlet, OpeningCondition::total_pressure);
  EXPECT_EQ(scene.output.fields_every, 0);
}

TEST(Scene, OverridesWinAndTheLastOneWinsOverAll) {
  const Scene scene =
      with({"operating_point.head_mmHg=55", "model.flow=stokes", "time.periods=3",
            "operating_point.head_mmHg=60", "name=\"a = b\"", "stabilisation.ghost_viscous=1"});
  EXPECT_DOUBLE_EQ(scene.operating_point.head, 60 * 1333.22387415);
  EXPECT_EQ(scene.flow, FlowModel::stokes);
  EXPECT_EQ(scene.time.periods, 3);
  EXPECT_EQ(scene.name, "a = b");
  EXPECT_DOUBLE_EQ(scene.stabilisation.ghost_viscous, 1);
}

TEST(Scene, AnOverrideAddsABoxOfRefinement) {
  const Scene scene = with({"refine.tip.box_mm=[[4.0, -1.0], [6.0, 1.0]]", "refine.tip.size_mm=0.1"});
  const auto& box = scene.problem.refinements.at("tip");
  EXPECT_DOUBLE_EQ(box.size, 0.01);
  EXPECT_DOUBLE_EQ(box.box.at(1).at(0), 0.6);
  EXPECT_NE(scene_hash(scene), scene_hash(with({})));
  const std::string text = scene_to_toml(scene);
  EXPECT_EQ(scene_to_toml(parse_scene(text, "recorded", "/")), text);
  EXPECT_THROW(with({"body.tip.size_mm=0.1"}), InputError);
}

TEST(Scene, TheResolvedSceneReadsBackBitForBit) {
  const Scene scene =
      with({"operating_point.stroke_mm=0.31415926535897931", "operating_point.head_mmHg=52.7182818",
            "mesh.growth=0.1", "membrane.damping_time_s=1.1e-4", "name=quote \" and hash #"});
  const std::string text = scene_to_toml(scene);
  const Scene again = parse_scene(text, "recorded", "/");
  Scene a = scene;
  Scene b = again;
  for (const SceneKey& key : scene_table()) {
    if (const auto* real = std::get_if<RealKey>(&key.value)) {
      EXPECT_EQ(real->field(a), real->field(b)) << key.path;
    } else if (const auto* integer = std::get_if<IntegerKey>(&key.value)) {
      EXPECT_EQ(integer->field(a), integer->field(b)) << key.path;
    } else if (const auto* choice = std::get_if<ChoiceKey>(&key.value)) {
      EXPECT_EQ(choice->get(a), choice->get(b)) << key.path;
    }
  }
  EXPECT_EQ(again.name, scene.name);
  EXPECT_EQ(again.profile, scene.profile);
  EXPECT_EQ(scene_to_toml(again), text);
}

TEST(Scene, EveryStrokeAndHeadOfAFineSweepReadsBackBitForBit) {
  for (int i = 1; i <= 400; ++i) {
    const std::string number = std::to_string(i / 7.0);
    const Scene scene = with({"operating_point.stroke_mm=" + number, "operating_point.head_mmHg=" + number});
    const Scene again = parse_scene(scene_to_toml(scene), "recorded", "/");
    EXPECT_EQ(again.operating_point.stroke, scene.operating_point.stroke) << number;
    EXPECT_EQ(again.operating_point.head, scene.operating_point.head) << number;
  }
}

TEST(Scene, EveryShippedSceneIsReadAndReadsBack) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(UNDULA_SOURCE_DIR "/data/scenes")) {
    const Scene scene = read_scene(entry.path());
    EXPECT_EQ(scene.name, entry.path().stem().string());
    const Scene again = parse_scene(scene_to_toml(scene), "recorded", "/");
    EXPECT_EQ(scene_to_toml(again), scene_to_toml(scene)) << entry.path();
    EXPECT_EQ(scene_hash(again), scene_hash(scene)) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 3);
}

TEST(Scene, TheShippedThinGapStatesItsLevelsAndItsTolerances) {
  const Scene scene = read_scene(UNDULA_SOURCE_DIR "/data/scenes/wave_pump_thin_gap.toml");
  EXPECT_EQ(scene.space, Space::thin_gap);
  EXPECT_EQ(scene.coupling, Coupling::implicit);
  EXPECT_EQ(scene.solid_model, SolidModel::von_karman);
  EXPECT_DOUBLE_EQ(scene.thin_gap.film_thickness, 0.005);
  EXPECT_EQ(scene.clearance_scale, 1);
  const std::vector<std::pair<std::string, double>> expected = {
      {"geometry.clearance_scale", 0.1},      {"geometry.rim_gap_scale", 0.2},
      {"membrane.young_dyn_per_cm2", 8.43e5}, {"membrane.damping_time_s", 1e-4},
      {"operating_point.stroke_scale", 0.02}, {"thin_gap.film_thickness_mm", 0.025}};
  ASSERT_EQ(scene.tolerances.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(scene.tolerances[i].key, expected[i].first);
    EXPECT_EQ(scene.tolerances[i].tolerance, expected[i].second);
  }
}

TEST(Scene, TheHashFollowsWhatShapesTheStateAndNothingElse) {
  const std::string hash = scene_hash(with({}));
  EXPECT_EQ(hash.size(), 16u);
  for (const char* text : {"operating_point.head_mmHg=50.000001", "mesh.growth=0.31", "time.scheme=bdf1",
                           "stabilisation.ghost_viscous=0.11", "model.flow=stokes", "time.ramp_periods=2"}) {
    EXPECT_NE(scene_hash(with({text})), hash) << text;
  }
  for (const char* text :
       {"time.periods=20", "name=other", "output.fields_every=4", "training.training_points=3"}) {
    EXPECT_EQ(scene_hash(with({text})), hash) << text;
  }
}

TEST(Scene, TheHashFollowsTheContentOfTheProfileNotItsPlace) {
  const ScratchFolder folder;
  const auto copy = folder.path() / "copy.toml";
  std::filesystem::copy_file(UNDULA_SOURCE_DIR "/data/profiles/wave_pump_profile.toml", copy);
  EXPECT_EQ(scene_hash(with({"geometry.profile=" + copy.string()})), scene_hash(with({})));
  std::ofstream(copy, std::ios::app) << "# changed\n";
  EXPECT_NE(scene_hash(with({"geometry.profile=" + copy.string()})), scene_hash(with({})));
}

TEST(SceneTable, EveryNumberIsRefusedBeyondBothEndsOfItsRange) {
  for (const SceneKey& key : scene_table()) {
    std::vector<std::string> beyond;
    if (const auto* real = std::get_if<RealKey>(&key.value)) {
      const AllowedRange& range = real->allowed;
      const double low = range.low_open ? range.low : std::nextafter(range.low, -HUGE_VAL);
      const double high = range.high_open ? range.high : std::nextafter(range.high, HUGE_VAL);
      beyond = {shortest_number(low), shortest_number(high), "nan", "inf", "-inf"};
    } else if (const auto* integer = std::get_if<IntegerKey>(&key.value)) {
      beyond = {std::to_string(integer->low - 1L), std::to_string(integer->high + 1L), "10.5"};
    } else if (const auto* choice = std::get_if<ChoiceKey>(&key.value)) {
      beyond = choice->planned;
      beyond.emplace_back("nothing-like-it");
    }
    for (const std::string& value : beyond) {
      EXPECT_THROW(with({key.path + "=" + value}), InputError) << key.path << " = " << value;
    }
  }
}

TEST(SceneTable, KeysAreUniqueAndEndInTheirUnit) {
  for (const SceneKey& key : scene_table()) {
    EXPECT_EQ(find_key(key.path), &key);
    EXPECT_FALSE(key.help.empty());
    if (!key.unit.empty()) {
      EXPECT_TRUE(key.path.ends_with("_" + key.unit)) << key.path;
    }
    EXPECT_TRUE(key.section().empty() || !section_help(key.section()).empty()) << key.path;
  }
}

TEST(SceneTable, TheNearestKeyIsFoundByEditDistance) {
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("same", "same"), 0);
  EXPECT_EQ(nearest_key("time.step_per_period").path, "time.steps_per_period");
  EXPECT_EQ(nearest_key("steps_per_period").path, "time.steps_per_period");
  EXPECT_EQ(nearest_key("fluid.desity_g_per_cm3").path, "fluid.density_g_per_cm3");
  EXPECT_EQ(nearest_key("membrane.desity_g_per_cm3").path, "membrane.density_g_per_cm3");
}

TEST(SceneTable, ThePageInTheDocsIsPrintedByTheTable) {
  EXPECT_EQ(text_of(UNDULA_SOURCE_DIR "/docs/scene.md"), scene_reference())
      << "update it: undula check --reference > docs/scene.md";
  const ScratchFolder folder;
  EXPECT_EQ(run_undula({"check", "--reference"}, folder.path()).out, scene_reference());
}

} // namespace
} // namespace undula::apps
