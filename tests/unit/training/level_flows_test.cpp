// Flows that are fitted and propagated are those of the level's own curve, on every level.
#include <gtest/gtest.h>

#include <cmath>

#include "fom/scene/scene_file.hpp"
#include "training/calibration/calibrate.hpp"
#include "training/calibration/scene_flows.hpp"
#include "training/training.hpp"

namespace undula::training {
namespace {

Scene coarse(const std::string& name, const std::vector<std::string>& more) {
  std::vector<std::string> settings = {
      "mesh.gap_elements=2",      "mesh.channel_size_mm=2.5", "mesh.membrane_size_mm=0.8", "mesh.growth=0.6",
      "time.steps_per_period=16", "time.periods=2",           "time.ramp_periods=0.5"};
  settings.insert(settings.end(), more.begin(), more.end());
  return read_scene(UNDULA_SOURCE_DIR "/data/scenes/" + name + ".toml", settings);
}

std::vector<double> curve_flows(const Scene& scene, std::span<const double> heads) {
  PhaseTimer timer;
  const auto level = prepare_level(scene, MPI_COMM_SELF, timer);
  std::vector<double> flows;
  for (const CurvePoint& point : level->curve(scene, heads)) flows.push_back(point.flow_l_per_min);
  return flows;
}

class LevelFlows : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(LevelFlows, AreThoseOfTheCurve) {
  const auto& [name, stroke] = GetParam();
  const Scene scene = coarse(name, {std::string("operating_point.stroke_mm=") + stroke});
  const std::vector<double> heads = {45};
  const auto expected = curve_flows(scene, heads);
  ASSERT_GT(std::abs(expected[0]), 1e-3);
  EXPECT_EQ(scene_flows(scene, heads, MPI_COMM_SELF).flow_l_per_min, expected);

  // What a calibration computes for a set of values: one target at the scene's own drive.
  TargetCurve target;
  target.frequency_Hz = 120;
  target.stroke_mm = std::stod(stroke);
  target.head_mmHg = heads;
  target.flow_l_per_min = {0};
  const std::vector<TargetCurve> targets = {target};
  const auto fitted = flows_of_scene(scene, {}, targets, MPI_COMM_SELF, {})(Eigen::VectorXd());
  ASSERT_TRUE(fitted.has_value());
  EXPECT_NEAR((*fitted)[0], expected[0], 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Levels, LevelFlows,
                         testing::Values(std::pair("wave_pump_fixed", "0.2"),
                                         std::pair("wave_pump_explicit", "0.2"),
                                         std::pair("wave_pump_mapped", "0.05"),
                                         std::pair("wave_pump_thin_gap", "0.2")),
                         [](const auto& one) { return std::string(one.param.first); });

TEST(LevelCurve, ASecondHeadStartsFromRestOnAMovedDomainToo) {
  for (const auto& [name, stroke] :
       {std::pair("wave_pump_explicit", "0.2"), std::pair("wave_pump_mapped", "0.05")}) {
    const Scene scene = coarse(name, {std::string("operating_point.stroke_mm=") + stroke});
    const std::vector<double> both = {30, 60}, alone = {60};
    EXPECT_EQ(curve_flows(scene, both)[1], curve_flows(scene, alone)[0]) << name;
  }
}

} // namespace
} // namespace undula::training
