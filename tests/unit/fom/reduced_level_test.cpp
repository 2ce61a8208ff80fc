// A reduced model behind the door.
#include "fom/levels/reduced_level.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "rom/base/units.hpp"

namespace undula::fom {
namespace {

const std::string file = UNDULA_SOURCE_DIR "/data/models/wave_pump_fixed.h5";

TEST(ReducedLevel, GivesTheCurveOfItsModelInTheOrderAsked) {
  ReducedLevel level(rom::load_model(file));
  const Scene scene = scene_of_model(level.model(), "wave_pump_fixed", 120, 0.53);
  const std::vector<double> heads = {60, 40};
  int told = 0;
  const auto points = level.curve(scene, heads, [&] { ++told; });
  const auto answers = rom::hq_curve(level.model(), 120, 0.53, heads);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(told, 2);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(points[i].head_mmHg, heads[i]);
    EXPECT_NEAR(points[i].flow_l_per_min, answers[i].flow_l_per_min, 1e-9);
    EXPECT_NEAR(points[i].error_l_per_min, answers[i].error_l_per_min, 1e-9);
    EXPECT_EQ(points[i].inside_training_box, true);
    EXPECT_TRUE(points[i].periodic);
    EXPECT_TRUE(std::isnan(points[i].clearance_min_mm)); // it does not know
  }
  EXPECT_TRUE(level.remarks(scene, heads).empty());
}

TEST(ReducedLevel, TakesTheStrokeThatTheHolderMakes) {
  ReducedLevel level(rom::load_model(file));
  Scene scaled = scene_of_model(level.model(), "scaled", 120, 0.5);
  scaled.operating_point.stroke_scale = 1.06;
  const std::vector<double> heads = {50};
  const auto plain = level.curve(scene_of_model(level.model(), "plain", 120, 0.53), heads);
  EXPECT_NEAR(level.curve(scaled, heads)[0].flow_l_per_min, plain[0].flow_l_per_min, 1e-9);
}

TEST(ReducedLevel, RemarksOnPointsOutsideItsBox) {
  const ReducedLevel level(rom::load_model(file));
  const std::vector<double> heads = {50, 90};
  const auto remarks = level.remarks(scene_of_model(level.model(), "far", 200, 0.53), heads);
  ASSERT_EQ(remarks.size(), 2u);
  EXPECT_NE(remarks[0].find("frequency"), std::string::npos);
  EXPECT_NE(remarks[1].find("90"), std::string::npos);
}

TEST(ReducedLevel, AStateThatIsNotFiniteIsNotPeriodic) {
  ReducedLevel level(rom::load_model(file));
  const std::vector<double> heads = {1e300};
  const auto point = level.curve(scene_of_model(level.model(), "far", 120, 0.53), heads)[0];
  EXPECT_FALSE(std::isfinite(point.flow_l_per_min));
  EXPECT_FALSE(point.periodic);
  EXPECT_NE(point.reason, "");
}

TEST(SceneOfModel, HoldsTheDriveAndTheBox) {
  const rom::Model model = rom::load_model(file);
  const Scene scene = scene_of_model(model, "name", 110, 0.4);
  EXPECT_EQ(scene.name, "name");
  EXPECT_EQ(scene.operating_point.frequency, 110);
  EXPECT_NEAR(scene.operating_point.stroke, 0.04, 1e-15);
  EXPECT_NEAR(units::pressure_to_mmHg(scene.training.head_high), model.box.head_high_mmHg, 1e-9);
}

} // namespace
} // namespace undula::fom
