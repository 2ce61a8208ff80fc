#include "rom/fixed_domain/condense.hpp"

#include <gtest/gtest.h>

#include "rom/fixed_domain/periodic.hpp"
#include "synthetic_operators.hpp"

namespace undula::rom {
namespace {

/// Operators whose pressure block is the projection of a stabilisation: symmetric, positive.
Operators stabilised() {
  auto operators = synthetic_operators({12, 5, 4}, 20.0);
  const Eigen::MatrixXd factor = Eigen::MatrixXd::Random(5, 5);
  operators.linear.block(12, 12, 5, 5) = factor * factor.transpose() + 0.1 * Eigen::MatrixXd::Identity(5, 5);
  return operators;
}

TEST(Condense, GivesTheSamePeriodicState) {
  const auto full = stabilised();
  const auto condensed = condense_pressure(full);
  ASSERT_EQ(condensed.pressure_modes, 0);
  ASSERT_EQ(condensed.linear.rows(), 16);
  PeriodicOptions options;
  options.tolerance = 1e-11;
  options.tail_tolerance = 1e-12;
  PeriodicSolver one(full, 120, 48, options), other(condensed, 120, 48, options);
  const auto a = one.solve(0.05, 3e4), b = other.solve(0.05, 3e4);
  ASSERT_TRUE(a.converged && b.converged);
  EXPECT_NEAR(a.mean_outflow, b.mean_outflow, 1e-8 * std::abs(a.mean_outflow));
  const Eigen::MatrixXd u = one.at_steps(a.velocity), v = other.at_steps(b.velocity);
  EXPECT_LT((u - v).norm(), 1e-8 * u.norm());
  const Eigen::MatrixXd d = one.at_steps(a.displacement), e = other.at_steps(b.displacement);
  EXPECT_LT((d - e).norm(), 1e-8 * d.norm());
}

TEST(Condense, LeavesAloneWhatCannotBeCondensed) {
  auto operators = stabilised();
  operators.linear.block(12, 12, 5, 5).setZero();
  EXPECT_EQ(condense_pressure(operators).pressure_modes, 5);
  operators = stabilised();
  operators.mass(13, 13) = 1.0;
  EXPECT_EQ(condense_pressure(operators).pressure_modes, 5);
}

} // namespace
} // namespace undula::rom
