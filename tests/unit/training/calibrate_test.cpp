// Calibration of a coarse thin-gap pump against curves that the same level computed: what was put in has to
// come out.
#include "training/calibration/calibrate.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fom/scene/scene_file.hpp"
#include "fom/scene/scene_value.hpp"
#include "rom/base/error.hpp"
#include "training/training.hpp"

namespace undula::training {
namespace {

Scene coarse_pump() {
  const std::vector<std::string> overrides = {"mesh.channel_size_mm=3",   "mesh.gap_elements=2",
                                              "thin_gap.cells=16",        "time.periods=40",
                                              "time.steps_per_period=24", "training.periodic_tolerance=5e-4"};
  return read_scene(UNDULA_SOURCE_DIR "/data/scenes/wave_pump_thin_gap.toml", overrides);
}

/// Targets with the flows of `scene` in place of measured ones.
std::vector<TargetCurve> computed_targets(const Scene& scene, std::vector<TargetCurve> targets) {
  const auto flows = flows_of_scene(scene, {}, targets, MPI_COMM_WORLD, {})(Eigen::VectorXd());
  Eigen::Index place = 0;
  for (TargetCurve& target : targets)
    for (std::size_t i = 0; i < target.head_mmHg.size(); ++i)
      target.flow_l_per_min.push_back((*flows)[place++]);
  return targets;
}

TEST(Calibrate, RecoversTheKeysOfItsOwnCurves) {
  const Scene scene = coarse_pump();
  const std::vector<FreeKey> keys = {{"geometry.clearance_scale", 0.8, 1.2},
                                     {"operating_point.stroke_scale", 0.9, 1.1}};
  const Eigen::Vector2d truth(1.06, 0.97);
  // Two frequencies and strokes, so that both keys are fixed.
  const auto targets =
      computed_targets(with_values(scene, keys, truth),
                       {{"a", 120, 0.53, {40, 55}, {}, 0.01}, {"b", 100, 0.6, {35, 50}, {}, 0.01}});
  const auto flows = flows_of_scene(scene, keys, targets, MPI_COMM_WORLD, {});
  const Calibration result = calibrate(flows, keys, values_of(scene, keys), targets);

  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.start, Eigen::Vector2d(1, 1));
  EXPECT_NEAR(result.optimum[0], truth[0], 0.01);
  EXPECT_NEAR(result.optimum[1], truth[1], 0.005);
  EXPECT_EQ(result.at_bound, (std::vector<bool>{false, false}));
  ASSERT_EQ(result.curves.size(), 2u);
  for (const CalibratedCurve& curve : result.curves) {
    EXPECT_GT(curve.start_rms_l_per_min, 0.05); // the start was wrong
    EXPECT_LT(curve.optimum_rms_l_per_min, 0.1 * curve.start_rms_l_per_min);
    EXPECT_GT(curve.sensitivity.col(1).minCoeff(), 0); // a longer stroke pumps more
  }
}

TEST(Calibrate, AKeyWithoutInfluenceIsNamed) {
  const Scene scene = coarse_pump();
  // The highest frequency of a training campaign is no matter of a curve.
  const std::vector<FreeKey> keys = {{"operating_point.stroke_scale", 0.9, 1.1},
                                     {"training.frequency_high_Hz", 130, 200}};
  Eigen::Vector2d start = values_of(scene, keys);
  start[0] = 0.96;
  const auto targets = computed_targets(scene, {{"a", 120, 0.53, {40, 55}, {}, 0.01}});
  const auto flows = flows_of_scene(scene, keys, targets, MPI_COMM_WORLD, {});
  const Calibration result = calibrate(flows, keys, start, targets);
  EXPECT_NEAR(result.optimum[0], 1, 0.005);
  EXPECT_EQ(result.identified.without_influence, (std::vector<int>{1}));
  EXPECT_TRUE(std::isinf(result.identified.standard_error[1]));
  EXPECT_TRUE(std::isfinite(result.identified.standard_error[0]));
  const auto statements = identifiability_statements(keys, result.identified);
  ASSERT_FALSE(statements.empty());
  EXPECT_NE(statements[0].find("training.frequency_high_Hz has no influence"), std::string::npos);
}

TEST(Calibrate, StandardErrorsAreThoseOfTheScatter) {
  // A linear model Q = a + b H / 10 at three heads: the errors are known.
  const std::vector<FreeKey> keys = {{"a", 0, 10}, {"b", -5, 5}};
  const std::vector<TargetCurve> targets = {{"line", 120, 0.5, {-10, 0, 10}, {1, 3, 5.3}, 0.2}};
  const FlowsOfValues flows = [](const Eigen::VectorXd& v) {
    return std::optional(Eigen::VectorXd(Eigen::Vector3d(v[0] - v[1], v[0], v[0] + v[1])));
  };
  const Calibration result = calibrate(flows, keys, Eigen::Vector2d(5, 0), targets);
  EXPECT_NEAR(result.optimum[0], 9.3 / 3, 0.02);
  EXPECT_NEAR(result.optimum[1], 4.3 / 2, 0.02);
  EXPECT_NEAR(result.identified.standard_error[0], 0.2 / std::sqrt(3.0), 1e-4);
  EXPECT_NEAR(result.identified.standard_error[1], 0.2 / std::sqrt(2.0), 1e-4);
  EXPECT_NEAR(result.identified.correlation(0, 1), 0, 1e-9);
  EXPECT_NEAR(result.curves[0].sensitivity(2, 1), 1, 1e-9);
  EXPECT_NEAR(result.curves[0].optimum_rms_l_per_min, std::sqrt(0.015 / 3 * 1), 0.01);
  EXPECT_TRUE(identifiability_statements(keys, result.identified).empty());
}

TEST(Calibrate, FreeKeysAreChecked) {
  const Scene scene = coarse_pump();
  const std::vector<std::vector<FreeKey>> wrong = {
      {{"geometry.rim_gap_scal", 0.8, 1.2}},
      {{"thin_gap.cells", 16, 32}},
      {{"geometry.rim_gap_scale", 1.2, 0.8}},
      {{"geometry.rim_gap_scale", 1, 1}},
      {{"geometry.rim_gap_scale", 0.01, 1.2}},
      {{"geometry.rim_gap_scale", 1.1, 1.2}},
      {{"operating_point.stroke_mm", 0.4, 0.6}},
      {{"geometry.rim_gap_scale", 0.8, std::nan("")}},
      {{"geometry.rim_gap_scale", 0.8, 1.2}, {"geometry.rim_gap_scale", 0.8, 1.2}}};
  for (const auto& keys : wrong) EXPECT_THROW(check_free_keys(scene, keys), InputError) << keys[0].key;
  EXPECT_NO_THROW(check_free_keys(scene, std::vector<FreeKey>{{"geometry.rim_gap_scale", 0.8, 1.2}}));
}

} // namespace
} // namespace undula::training
