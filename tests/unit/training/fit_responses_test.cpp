// The course over a period between runs: of runs whose course is known.
#include "training/emulation/fit_responses.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "training/sampling/scrambled_halton.hpp"

namespace undula::training {
namespace {

constexpr int phases = 24, places = 5;

/// Two waves whose amplitudes and phase follow drive and head in curves.
Eigen::VectorXd course(double drive, double head) {
  Eigen::VectorXd values(phases * places);
  for (int k = 0; k < phases; ++k)
    for (int i = 0; i < places; ++i) {
      const double turn = 2 * std::numbers::pi * k / phases;
      values[k * places + i] = (1 + drive * drive) * std::sin(turn - 0.3 * i - 0.5 * head) +
                               0.2 * std::exp(-head) * std::cos(2 * turn + i);
    }
  return values;
}

struct Runs {
  RecordedResponse recorded{"membrane_mm", "mm", {1, 2, 3, 4, 5}, phases, {}, {}};
  std::vector<rom::EmulatorPoint> training, held_out;
  rom::Emulator emulator;
};

Runs known_runs(int count) {
  Runs runs;
  runs.emulator.inputs = {{"frequency", "Hz", 120, 120}, {"voltage", "V", 0, 1}, {"head", "mmHg", 0, 1}};
  const ScrambledHalton points(7, 2);
  const auto add = [](Eigen::MatrixXd& all, const Eigen::VectorXd& values) {
    all.conservativeResize(values.size(), all.cols() + 1);
    all.rightCols(1) = values;
  };
  for (int k = 1; k <= count + 6; ++k) {
    const auto x = points(k);
    const bool held = k > count;
    (held ? runs.held_out : runs.training).push_back({120, x[0], x[1]});
    add(held ? runs.recorded.held_out : runs.recorded.training, course(x[0], x[1]));
  }
  return runs;
}

TEST(FitResponses, SayTheCourseBetweenRunsAndHowFarTheyAreOff) {
  Runs runs = known_runs(20);
  const auto score = fit_response(runs.recorded, runs.training, runs.held_out, runs.emulator);
  EXPECT_GE(score.modes, 3);
  EXPECT_LT(score.held_out, 0.01);
  EXPECT_LT(score.envelope_held_out, 0.01);
  EXPECT_LT(score.left_out, 0.03);
  ASSERT_EQ(runs.emulator.responses.size(), 1U);
  const auto& response = runs.emulator.responses.front();
  EXPECT_EQ(rom::find_response(runs.emulator, "membrane_mm"), &response);
  const auto between = rom::emulate(runs.emulator, response, {120, 0.45, 0.55});
  ASSERT_EQ(between.values.rows(), places);
  ASSERT_EQ(between.values.cols(), phases);
  const Eigen::VectorXd exact = course(0.45, 0.55);
  EXPECT_LT((between.values.reshaped() - exact).norm(), 0.02 * exact.norm());
  EXPECT_NEAR(between.values(3, 7), exact[7 * places + 3], 0.05);
  EXPECT_EQ(between.error, response.error);
  EXPECT_GT(rom::emulate(runs.emulator, response, {120, 1.2, 0.5}).error, 2 * response.error);
}

// Where the inputs tell nothing of the course, no mode is kept, and the error says what is not known.
TEST(FitResponses, KeepNoModesThatTheInputsDoNotTell) {
  Runs runs = known_runs(12), known = known_runs(12);
  fit_response(known.recorded, known.training, known.held_out, known.emulator);
  for (std::size_t k = 0; k < 6; ++k) std::swap(runs.training[k], runs.training[11 - k]);
  std::swap(runs.training[2], runs.training[5]);
  std::swap(runs.training[1], runs.training[8]);
  const auto score = fit_response(runs.recorded, runs.training, runs.held_out, runs.emulator);
  EXPECT_GT(score.held_out, 0.2);
  EXPECT_GT(runs.emulator.responses.front().error, 5 * known.emulator.responses.front().error);
}

} // namespace
} // namespace undula::training
