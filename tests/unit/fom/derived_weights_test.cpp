// The velocity and the weights that a scene derives.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "fom/levels/scene_problem.hpp"
#include "fom/scene/scene_file.hpp"

namespace undula::fom {
namespace {

const std::string data = UNDULA_SOURCE_DIR "/data/scenes/";

Scene scene_of(const std::string& name, const std::vector<std::string>& settings = {}) {
  return read_scene(data + name + ".toml", settings);
}

StabilisationWeights weights_of(const std::string& name, const std::vector<std::string>& settings = {}) {
  return scene_problem(scene_of(name, settings)).stabilisation;
}

// 1.5 times the mean inflow: the top of the parabola lies in the middle of the side.
TEST(DerivedWeights, VelocityIsThatOfTheInflow) {
  EXPECT_DOUBLE_EQ(scene_of("turek_hron_fsi2").stabilisation.reference_velocity, 150);
  EXPECT_DOUBLE_EQ(scene_of("turek_hron_fsi2", {"constants.U=50"}).stabilisation.reference_velocity, 75);
}

TEST(DerivedWeights, VelocityIsThatOfAHeldBody) { // falls by 1 mm/s
  EXPECT_DOUBLE_EQ(scene_of("sphere_to_wall").stabilisation.reference_velocity, 0.1);
  EXPECT_DOUBLE_EQ(scene_of("sphere_to_wall", {"constants.V=3"}).stabilisation.reference_velocity, 0.3);
}

TEST(DerivedWeights, VelocityIsThatAtTheStart) { // of the ring, 0.1 cm/s
  EXPECT_DOUBLE_EQ(scene_of("elastic_ring").stabilisation.reference_velocity, 0.1);
}

// 10 mmHg: sqrt(2 * 13332 / 1) = 163 cm/s. In a tough fluid it goes with 1 / viscosity, but for two digits.
TEST(DerivedWeights, VelocityIsThatOfAPressure) {
  const auto velocity = [](const char* viscosity) {
    return scene_of("closed_valve", {std::string("fluid.viscosity_poise=") + viscosity})
        .stabilisation.reference_velocity;
  };
  EXPECT_DOUBLE_EQ(velocity("0.035"), 160);
  EXPECT_DOUBLE_EQ(velocity("1e4"), 0.69);
  EXPECT_DOUBLE_EQ(velocity("5e3"), 1.4);
}

TEST(DerivedWeights, TimeIsTheStep) {
  EXPECT_DOUBLE_EQ(weights_of("turek_hron_fsi2").reference_time, 0.005);
  EXPECT_DOUBLE_EQ(weights_of("turek_hron_fsi2", {"time.step_s=0.0025"}).reference_time, 0.0025);
  EXPECT_DOUBLE_EQ(weights_of("turek_hron_fsi2", {"stabilisation.reference_time_s=0.1"}).reference_time, 0.1);
}

// A pump's scales follow the frequency, whatever head and stroke a curve asks for.
TEST(DerivedWeights, OfAPumpFollowTheFrequency) {
  const std::vector<std::string> derived = {"stabilisation.weights=derived"};
  auto twice = derived, head = derived;
  twice.emplace_back("operating_point.frequency_Hz=240");
  head.insert(head.end(), {"operating_point.head_mmHg=0", "operating_point.stroke_mm=0.1"});
  const auto weights = weights_of("wave_pump_fixed", derived), fast = weights_of("wave_pump_fixed", twice),
             other = weights_of("wave_pump_fixed", head);
  EXPECT_GT(weights.reference_velocity, 50);
  EXPECT_LT(weights.reference_velocity, 500);
  EXPECT_NEAR(fast.reference_velocity, 2 * weights.reference_velocity, 1e-9);
  EXPECT_NEAR(weights.reference_time, 1 / (120.0 * 96), 1e-12);
  EXPECT_EQ(weights.velocity_scale, VelocityScale::local);
  EXPECT_DOUBLE_EQ(other.reference_velocity, weights.reference_velocity);
  EXPECT_DOUBLE_EQ(other.reference_time, weights.reference_time);
}

TEST(PublishedWeights, AreStatedByOneWord) {
  const auto weights = weights_of("turek_hron_fsi2", {"stabilisation.weights=published"});
  EXPECT_DOUBLE_EQ(weights.velocity_jump, 0.05);
  EXPECT_DOUBLE_EQ(weights.divergence, 0.05);
  EXPECT_DOUBLE_EQ(weights.reference_velocity, 100);
  EXPECT_DOUBLE_EQ(weights.reference_time, 2e-4);
  EXPECT_EQ(weights.velocity_scale, VelocityScale::reference);
  // What stands beside the word holds.
  EXPECT_DOUBLE_EQ(
      weights_of("turek_hron_fsi2", {"stabilisation.weights=published", "stabilisation.divergence=0.3"})
          .divergence,
      0.3);
}

} // namespace
} // namespace undula::fom
