#include "rom/fixed_domain/periodic.hpp"

#include <gtest/gtest.h>

#include "rom/base/error.hpp"
#include "rom/base/gmres.hpp"
#include "rom/fixed_domain/time_march.hpp"
#include "synthetic_operators.hpp"

namespace undula::rom {
namespace {

// The marched state, for as long as it takes to be periodic to round-off.
PeriodicState marched(const Operators& o, double frequency, int steps, double stroke, double head) {
  PeriodicOptions options;
  options.direct = false;
  options.march_tolerance = 1e-12;
  options.march_periods = 400;
  return PeriodicSolver(o, frequency, steps, options).solve(stroke, head);
}

PeriodicOptions tight() {
  PeriodicOptions options;
  options.tolerance = 1e-11;
  options.tail_tolerance = 1e-10;
  return options;
}

struct Case {
  double convection;
  int steps;
};

class PeriodicAgainstMarch : public testing::TestWithParam<Case> {};

TEST_P(PeriodicAgainstMarch, IsTheSameDiscreteState) {
  const auto [convection, steps] = GetParam();
  const auto o = synthetic_operators({20, 6, 4}, convection);
  PeriodicSolver solver(o, 100, steps, tight());
  const auto direct = solver.solve(0.05, 2e4);
  const auto march = marched(o, 100, steps, 0.05, 2e4);
  ASSERT_TRUE(direct.converged && direct.direct);
  ASSERT_TRUE(march.converged && !march.direct);
  EXPECT_NEAR(direct.mean_outflow, march.mean_outflow, 1e-8 * std::abs(march.mean_outflow));
  const auto compare = [&](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    const Eigen::MatrixXd x = solver.at_steps(a), y = solver.at_steps(b);
    EXPECT_LT((x - y).norm(), 1e-8 * y.norm());
  };
  compare(direct.velocity, march.velocity);
  compare(direct.y, march.y);
  compare(direct.displacement, march.displacement);
  if (convection > 0) { // the mean flow must come from convection for this to mean anything
    const auto linear = synthetic_operators({20, 6, 4}, 0.0);
    const auto without = PeriodicSolver(linear, 100, steps, tight()).solve(0.05, 2e4);
    EXPECT_GT(std::abs(without.mean_outflow - direct.mean_outflow), 0.1 * std::abs(direct.mean_outflow));
  }
}

INSTANTIATE_TEST_SUITE_P(Strengths, PeriodicAgainstMarch,
                         testing::Values(Case{0, 96}, Case{10, 96}, Case{30, 48}, Case{30, 47}, Case{100, 96},
                                         Case{30, 8}));

TEST(PeriodicSolver, DefaultTolerancesGiveTheFlowToOneInAMillion) {
  for (const double convection : {10.0, 50.0}) {
    const auto o = synthetic_operators({20, 6, 4}, convection);
    const auto direct = PeriodicSolver(o, 100, 96).solve(0.05, 2e4);
    const auto march = marched(o, 100, 96, 0.05, 2e4);
    ASSERT_TRUE(direct.direct);
    EXPECT_LT(direct.velocity.cols(), 96) << "all harmonics kept: the test says nothing about truncation";
    EXPECT_NEAR(direct.mean_outflow, march.mean_outflow, 1e-6 * std::abs(march.mean_outflow));
  }
}

TEST(PeriodicSolver, OscillationStreamsAMeanFlow) {
  // No head: the linear model has no mean flow at all, and the quadratic one has a mean that grows as
  // stroke^2.
  const auto quiet = synthetic_operators({20, 6, 4}, 0.0);
  EXPECT_NEAR(PeriodicSolver(quiet, 100, 96).solve(0.05, 0).mean_outflow, 0, 1e-12);
  const auto o = synthetic_operators({20, 6, 4}, 10.0);
  PeriodicSolver solver(o, 100, 96, tight());
  const double small = solver.solve(0.001, 0).mean_outflow, twice = solver.solve(0.002, 0).mean_outflow;
  EXPECT_GT(std::abs(small), 1e-6);
  EXPECT_NEAR(twice / small, 4.0, 0.01);
}

TEST(PeriodicSolver, TheMarchStaysOnTheDirectState) {
  const auto o = synthetic_operators({16, 5, 4}, 30.0, 3);
  PeriodicSolver solver(o, 110, 48, tight());
  const auto state = solver.solve(0.06, 2e4);
  const auto y = solver.at_steps(state.y), d = solver.at_steps(state.displacement);
  TimeMarch march(o, {110, 0.06, 2e4}, 48, 2);
  Eigen::MatrixXd y_start(y.rows(), 2), d_start(d.rows(), 2);
  y_start << y.rightCols(1), y.leftCols(1);
  d_start << d.rightCols(1), d.leftCols(1);
  march.start_from(y_start, d_start);
  for (int period = 0; period < 5; ++period) {
    const auto record = march.period();
    EXPECT_NEAR(record.mean_outflow, state.mean_outflow, 1e-9 * std::abs(state.mean_outflow));
  }
}

TEST(PeriodicSolver, FallsBackToTheMarchAndSaysSo) {
  const auto o = synthetic_operators({16, 5, 4}, 30.0, 3);
  PeriodicOptions hopeless;
  hopeless.newton_iterations = 1;
  const auto state = PeriodicSolver(o, 110, 48, hopeless).solve(0.06, 2e4);
  EXPECT_FALSE(state.direct);
  EXPECT_TRUE(state.converged);
  EXPECT_GT(state.marched_periods, 5);
  EXPECT_NEAR(state.mean_outflow, PeriodicSolver(o, 110, 48).solve(0.06, 2e4).mean_outflow,
              1e-6 * std::abs(state.mean_outflow));
}

TEST(PeriodicSolver, ReportsTheSpreadOfAStateThatIsNotPeriodic) {
  // Convection this strong makes the flow irregular (the march never repeats itself).
  const auto o = synthetic_operators({20, 6, 4}, 300.0);
  PeriodicOptions options;
  options.direct = false;
  options.march_periods = 60;
  const auto state = PeriodicSolver(o, 100, 96, options).solve(0.05, 0);
  EXPECT_FALSE(state.converged);
  EXPECT_FALSE(state.direct);
  EXPECT_EQ(state.marched_periods, 60);
  EXPECT_GT(state.outflow_spread, 1e-3);
}

TEST(PeriodicSolver, NamesASingularLinearPart) {
  auto o = synthetic_operators({6, 4, 2}, 0.0);
  o.linear.block(6, 0, 1, 12).setZero(); // a pressure mode no velocity answers to
  o.linear.block(0, 6, 12, 1).setZero();
  EXPECT_THROW(PeriodicSolver(o, 100, 48).solve(0.01, 1e4), NumericsError);
  EXPECT_THROW(PeriodicSolver(o, -1, 48), InputError);
}

TEST(Harmonics, AnalysisInvertsSynthesis) {
  for (const int steps : {8, 9, 48})
    for (const int harmonics : {1, 3, steps / 2}) {
      const Harmonics h(steps, harmonics);
      const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(h.coefficients(), h.coefficients());
      EXPECT_LT((h.synthesis() * h.analysis() - identity).norm(), 1e-13) << steps << " " << harmonics;
    }
}

TEST(Gmres, SolvesARandomSystem) {
  std::srand(4);
  const Eigen::MatrixXd a = Eigen::MatrixXd::Identity(30, 30) + 0.1 * Eigen::MatrixXd::Random(30, 30);
  const Eigen::MatrixXd exact = Eigen::MatrixXd::Random(10, 3);
  const auto apply = [&](const Eigen::MatrixXd& in, Eigen::MatrixXd& out) {
    out.resize(10, 3);
    out.reshaped() = a * Eigen::VectorXd(in.reshaped());
  };
  Eigen::MatrixXd b, x;
  apply(exact, b);
  const auto result = gmres(apply, b, x, 1e-12, 30);
  EXPECT_LE(result.relative_residual, 1e-12);
  EXPECT_LT((x - exact).norm(), 1e-10 * exact.norm());
  gmres(apply, Eigen::MatrixXd::Zero(10, 3), x, 1e-12, 30);
  EXPECT_EQ(x, Eigen::MatrixXd::Zero(10, 3));
}

TEST(Periodic, AHeadBeyondAllReasonHasNoPeriodicState) {
  const auto operators = synthetic_operators({4, 2, 2}, 0.1);
  for (const double head : {1e300, std::numeric_limits<double>::infinity()}) {
    PeriodicSolver solver(operators, 120, 48);
    EXPECT_FALSE(solver.solve(0.05, head).converged) << head;
  }
}

} // namespace
} // namespace undula::rom
