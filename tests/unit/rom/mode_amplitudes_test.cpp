#include "rom/curve/mode_amplitudes.hpp"

#include <gtest/gtest.h>

#include "rom/base/units.hpp"
#include "synthetic_operators.hpp"

namespace undula::rom {
namespace {

Model synthetic_model() {
  Model model;
  model.operators = synthetic_operators({6, 3, 4}, 0.1);
  model.operators.imposed_linear.segment(6, 3).setConstant(0.7); // the holder is felt by the pressure
  model.steps_per_period = 48;
  model.box = {80, 140, 0.1, 0.8, 0, 70};
  return model;
}

TEST(ModeAmplitudes, TheRecoveredPressureIsThatOfTheWholeSystem) {
  const Model model = synthetic_model();
  HqOptions options;
  options.periodic.tolerance = 1e-10;
  options.periodic.tail_tolerance = 1e-12;
  const auto amplitudes = mode_amplitudes(model, 120, 0.5, 40, options);
  ASSERT_TRUE(amplitudes.periodic);

  // All unknowns at once, the pressure among them.
  PeriodicSolver solver(model.operators, 120, model.steps_per_period, options.periodic);
  const auto state = solver.solve(units::length_from_mm(0.5), units::pressure_from_mmHg(40));
  ASSERT_TRUE(state.converged);
  const Eigen::MatrixXd y = solver.at_steps(state.y);
  const Eigen::MatrixXd pressure = y.middleRows(6, 3);
  EXPECT_GT(pressure.norm(), 0);
  EXPECT_LT((amplitudes.pressure - pressure).norm(), 1e-7 * pressure.norm());
  EXPECT_LT((amplitudes.velocity - y.topRows(6)).norm(), 1e-7 * y.topRows(6).norm());
  EXPECT_LT((amplitudes.displacement - solver.at_steps(state.displacement)).norm(),
            1e-7 * amplitudes.displacement.norm());
  EXPECT_NEAR(amplitudes.holder_cm.maxCoeff(), units::length_from_mm(0.5), 1e-15);
  EXPECT_DOUBLE_EQ(amplitudes.time_s[1] * 48 * 120, 1);
}

TEST(ModeAmplitudes, WithoutPressureModesThereIsNone) {
  Model model = synthetic_model();
  model.operators = synthetic_operators({6, 0, 4}, 0.1);
  const auto amplitudes = mode_amplitudes(model, 120, 0.5, 40);
  EXPECT_EQ(amplitudes.pressure.rows(), 0);
  EXPECT_EQ(amplitudes.pressure.cols(), 48);
}

} // namespace
} // namespace undula::rom
