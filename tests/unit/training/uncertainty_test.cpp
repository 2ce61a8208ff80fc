// Tolerances of a scene as a band of its curve, with functions whose band is known.
#include "training/calibration/uncertainty.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fom/scene/scene_file.hpp"
#include "fom/scene/scene_tolerance.hpp"
#include "fom/scene/scene_value.hpp"
#include "rom/base/error.hpp"
#include "training/training.hpp"

namespace undula::training {
namespace {

constexpr const char* stroke = "operating_point.stroke_mm";
constexpr const char* young = "membrane.young_dyn_per_cm2";
constexpr const char* damping = "membrane.damping_time_s";

Scene pump() {
  Scene scene = read_scene(UNDULA_SOURCE_DIR "/data/scenes/wave_pump_thin_gap.toml");
  scene.tolerances.clear();
  return scene;
}

/// 10 (stroke - 0.5) and 4 stroke - 2e-7 young, at two heads.
std::vector<double> linear(const Scene& scene) {
  const double phi = surface_value(scene, stroke), modulus = surface_value(scene, young);
  return {10 * (phi - 0.5), 4 * phi - 2e-7 * modulus};
}

TEST(UncertaintyMpi, OfALinearFunctionIsExact) {
  Scene scene = pump();
  set_tolerance(scene, stroke, 0.01);
  set_tolerance(scene, young, 5e5);
  const auto nominal = linear(scene);
  const UncertaintyBand band = propagate_tolerances(scene, nominal, linear, MPI_COMM_WORLD);
  ASSERT_EQ(band.half_width.size(), 2u);
  EXPECT_NEAR(band.half_width[0], 0.1, 1e-9);
  EXPECT_NEAR(band.half_width[1], std::hypot(0.04, 0.1), 1e-9);
  EXPECT_NEAR(band.low[1], band.half_width[1], 1e-9);
  EXPECT_NEAR(band.high[1], band.half_width[1], 1e-9);
  ASSERT_EQ(band.inputs.size(), 2u);
  EXPECT_EQ(band.inputs[0].key, young); // order of the scene table
  EXPECT_EQ(band.inputs[0].tolerance, 5e5);
  EXPECT_NEAR(band.inputs[0].up[1], -0.1, 1e-9);
  EXPECT_NEAR(band.inputs[0].down[1], 0.1, 1e-9);
  EXPECT_NEAR(band.inputs[0].up[0], 0, 1e-12); // no influence at the first head
  EXPECT_NEAR(band.inputs[1].up[0], 0.1, 1e-9);
  EXPECT_EQ(band.inputs[1].note, "");

  set_tolerance(scene, stroke, 0.02);
  set_tolerance(scene, young, 1e6);
  const UncertaintyBand twice = propagate_tolerances(scene, nominal, linear, MPI_COMM_WORLD);
  EXPECT_NEAR(twice.half_width[0], 2 * band.half_width[0], 1e-9);
  EXPECT_NEAR(twice.half_width[1], 2 * band.half_width[1], 1e-9);
}

TEST(UncertaintyMpi, ComputationsAreDealtOutOverTheRanks) {
  Scene scene = pump();
  set_tolerance(scene, stroke, 0.01);
  set_tolerance(scene, young, 5e5);
  int calls = 0, ranks = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const FlowsOfScene counted = [&](const Scene& changed) {
    ++calls;
    return linear(changed);
  };
  propagate_tolerances(scene, linear(scene), counted, MPI_COMM_WORLD);
  EXPECT_EQ(calls, 4 / ranks);
}

TEST(Uncertainty, SidesThatDifferGiveLowAndHigh) {
  Scene scene = pump();
  set_tolerance(scene, stroke, 0.01);
  // Both ends pump less than the middle.
  const FlowsOfScene peak = [](const Scene& changed) {
    const double off = (surface_value(changed, stroke) - 0.53) / 0.01;
    return std::vector<double>{1 - 0.3 * off * off - 0.1 * off};
  };
  const auto band = propagate_tolerances(scene, peak(scene), peak, MPI_COMM_WORLD);
  EXPECT_NEAR(band.half_width[0], 0.1, 1e-9);
  EXPECT_NEAR(band.low[0], 0.4, 1e-9);
  EXPECT_NEAR(band.high[0], 0, 1e-9);
}

TEST(Uncertainty, ASideOutOfRangeOrFailingLeavesTheOther) {
  Scene scene = pump();
  const double value = surface_value(scene, damping);
  set_tolerance(scene, damping, 2 * value); // below: negative
  const FlowsOfScene flows = [](const Scene& changed) {
    if (surface_value(changed, stroke) > 0.535) throw NumericsError("a", "b", "c");
    return std::vector<double>{1e4 * surface_value(changed, damping) + 10 * surface_value(changed, stroke)};
  };
  auto band = propagate_tolerances(scene, flows(scene), flows, MPI_COMM_WORLD);
  EXPECT_NEAR(band.half_width[0], 1e4 * 2 * value, 1e-9);
  EXPECT_TRUE(std::isnan(band.inputs[0].down[0]));
  EXPECT_NE(band.inputs[0].note.find("out of range"), std::string::npos) << band.inputs[0].note;

  scene.tolerances.clear();
  set_tolerance(scene, stroke, 0.01);
  band = propagate_tolerances(scene, flows(scene), flows, MPI_COMM_WORLD);
  EXPECT_NEAR(band.half_width[0], 0.1, 1e-9);
  EXPECT_NE(band.inputs[0].note.find("fail"), std::string::npos);

  // Where both sides fail nothing is known, and nothing is claimed.
  const FlowsOfScene never = [](const Scene&) {
    return std::vector<double>{std::numeric_limits<double>::quiet_NaN()};
  };
  const std::vector<double> nominal = {1};
  EXPECT_TRUE(std::isnan(propagate_tolerances(scene, nominal, never, MPI_COMM_WORLD).half_width[0]));
}

TEST(Uncertainty, ASceneWithoutTolerancesIsToldWhatToWrite) {
  const Scene scene = pump();
  try {
    propagate_tolerances(scene, linear(scene), linear, MPI_COMM_WORLD);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("tolerance = 0.01"), std::string::npos) << error.what();
  }
}

} // namespace
} // namespace undula::training
