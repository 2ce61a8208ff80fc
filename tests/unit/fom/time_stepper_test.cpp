// Time stepping of a small coupled problem: constraints, restart, ranks.
#include "fom/time/time_stepper.hpp"

#include <gtest/gtest.h>

#include "fom/time/step_parts.hpp"
#include "tests/verification/support/channel_problem.hpp"

namespace undula::fom {
namespace {

using namespace verification;
using Sizes = ChannelSizes;
constexpr double dt = 1.0 / (Sizes::frequency * 64);

struct Channel {
  explicit Channel(MPI_Comm comm = PETSC_COMM_SELF, int velocity_order = 1, double wall_rate = 3) {
    auto problem = channel_with_plate(Space::axisymmetric, velocity_order);
    problem.boundary.at("wall").velocity = [wall_rate](const Point<2>& x, double t) {
      return Point<2>(0.0, wall_rate * t * x[1] * (Sizes::height - x[1]));
    };
    disc = discretise(std::move(problem), CutOptions{});
    operators = build_operators(disc, comm, timer);
  }
  State march(TimeScheme scheme, int steps, int factor_every, State state) {
    TimeStepper<2> stepper(disc, operators, scheme, dt, factor_every, timer);
    while (state.step < steps) stepper.advance(state);
    return state;
  }
  State march(TimeScheme scheme, int steps, int factor_every = 1) {
    return march(scheme, steps, factor_every, initial_state(disc));
  }
  PhaseTimer timer;
  Discretisation<2> disc;
  Operators<2> operators;
};

TEST(BdfCoefficients, DifferentiateLinesAndParabolas) {
  const auto derivative = [](TimeScheme scheme, int step, auto&& y) {
    const auto a = bdf_coefficients(scheme, step);
    return (a[0] * y(1.0) + a[1] * y(0.75) + a[2] * y(0.5)) / 0.25;
  };
  const auto line = [](double t) { return 3 - 2 * t; };
  const auto parabola = [](double t) { return t * t; };
  EXPECT_DOUBLE_EQ(derivative(TimeScheme::bdf1, 5, line), -2);
  EXPECT_DOUBLE_EQ(derivative(TimeScheme::bdf2, 5, line), -2);
  EXPECT_DOUBLE_EQ(derivative(TimeScheme::bdf2, 2, parabola), 2);
  EXPECT_EQ(bdf_coefficients(TimeScheme::bdf2, 1), bdf_coefficients(TimeScheme::bdf1, 1)); // no history yet
}

TEST(TimeStepper, MeetsImposedValuesExactly) {
  Channel run;
  for (const auto scheme : {TimeScheme::bdf1, TimeScheme::bdf2}) {
    const auto state = run.march(scheme, 5);
    ASSERT_FALSE(run.disc.imposed.empty());
    const double target = Sizes::holder(state.time);
    for (const auto& node : run.disc.imposed) {
      EXPECT_NEAR(state.d[0][node.unknown], 0, 1e-16);
      EXPECT_NEAR(state.d[0][node.unknown + 1], target, 1e-14 * target);
    }
    int moving = 0;
    for (const auto& constrained : run.disc.constrained) {
      const double value =
          constrained.condition && constrained.condition->velocity
              ? constrained.condition->velocity(constrained.position, state.time)[constrained.component]
              : 0.0;
      EXPECT_NEAR(state.x[0][constrained.unknown], value, 1e-15);
      moving += value != 0;
    }
    EXPECT_GT(moving, 3);
    // The rest of the plate follows, but not rigidly, and the displacement is the integral of the velocity.
    const int tip = run.disc.solid_unknown(0, 0, 1);
    EXPECT_GT(std::abs(state.d[0][tip]), 0.01 * target);
    EXPECT_GT(std::abs(state.d[0][tip] / target - 1), 1e-3);
  }
}

TEST(LinearSystem, HasIdentityRowsForConstrainedUnknowns) {
  Channel run;
  LinearSystem<2> system(run.disc, run.operators, 1, run.timer);
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(run.disc.unknowns());
  system.assemble({1.5 / dt, dt / 1.5}, &b);
  int constrained = 0;
  for (int unknown = 0; unknown < run.disc.unknowns(); ++unknown) {
    const PetscInt row = run.operators.ownership.petsc_index[unknown];
    PetscInt count = 0;
    const PetscInt* columns = nullptr;
    const PetscScalar* values = nullptr;
    check_petsc(MatGetRow(system.matrix(), row, &count, &columns, &values), "reading a row");
    double off_diagonal = 0, diagonal = 0;
    for (PetscInt k = 0; k < count; ++k) (columns[k] == row ? diagonal : off_diagonal) += std::abs(values[k]);
    check_petsc(MatRestoreRow(system.matrix(), row, &count, &columns, &values), "reading a row");
    if (run.disc.is_constrained[unknown]) {
      ++constrained;
      EXPECT_EQ(diagonal, 1.0);
      EXPECT_EQ(off_diagonal, 0.0);
    } else {
      EXPECT_GT(off_diagonal, 0.0);
    }
  }
  EXPECT_EQ(constrained, static_cast<int>(run.disc.constrained.size() + 2 * run.disc.imposed.size()));
}

/// Bit for bit: nothing but State survives the stop.
TEST(TimeStepper, GoesOnAfterARestartAsIfItHadNotStopped) {
  for (const int factor_every : {1, 4}) {
    SCOPED_TRACE("factor_every = " + std::to_string(factor_every));
    Channel run, other;
    const auto through = run.march(TimeScheme::bdf2, 12, factor_every);
    const auto stopped = run.march(TimeScheme::bdf2, 8, factor_every);
    const auto resumed = other.march(TimeScheme::bdf2, 12, factor_every, stopped);
    EXPECT_EQ(through.time, resumed.time);
    for (int level : {0, 1}) {
      EXPECT_TRUE(through.x[level] == resumed.x[level]) << "level " << level;
      EXPECT_TRUE(through.d[level] == resumed.d[level]) << "level " << level;
    }
    EXPECT_FALSE(through.x[0] == stopped.x[0]);
  }
}

/// What comes in and is not dissipated is the growth of Dahlquist's energy and what the scheme takes, step by
/// step: ((3 x - 4 x' + x'') / 2, x) = (|x|^2 + |2 x - x'|^2 - |x'|^2 - |2 x' - x''|^2) / 4 + |x - 2 x' +
/// x''|^2 / 4.
TEST(TimeStepper, WhatTheSchemeTakesClosesTheBalanceOfEnergy) {
  Channel run;
  TimeStepper<2> stepper(run.disc, run.operators, TimeScheme::bdf2, dt, 1, run.timer);
  State state = initial_state(run.disc);
  const auto stored = [&](const State& at) {
    const auto norm = [](const SparseMatrix& matrix, const Eigen::VectorXd& x) { return x.dot(matrix * x); };
    return 0.25 *
           (norm(run.operators.mass, at.x[0]) + norm(run.operators.mass, 2 * at.x[0] - at.x[1]) +
            norm(run.operators.stiffness, at.d[0]) + norm(run.operators.stiffness, 2 * at.d[0] - at.d[1]));
  };
  for (int k = 0; k < 3; ++k) stepper.advance(state);
  for (int k = 0; k < 5; ++k) {
    const double before = stored(state);
    stepper.advance(state);
    const auto terms = stepper.energy(state, stepper.residual(state));
    const double in = terms.holder + terms.boundary + terms.opening + terms.body,
                 spent = terms.viscous + terms.stabilisation + terms.damping + terms.carried;
    EXPECT_GT(terms.scheme, 1e-3 * std::abs(in));
    EXPECT_NEAR((in - spent) * dt, stored(state) - before + terms.scheme * dt, 1e-6 * std::abs(in) * dt);
  }
}

TEST(TimeStepper, KeepsAFactorisationWithoutChangingTheAnswer) {
  Channel run;
  const auto every = run.march(TimeScheme::bdf2, 10, 1), fifth = run.march(TimeScheme::bdf2, 10, 5);
  EXPECT_LT((every.d[0] - fifth.d[0]).norm(), 1e-7 * every.d[0].norm());
  EXPECT_FALSE(every.x[0] == fifth.x[0]);
}

/// A wall that drags the fluid along from one step to the next: the factors of a fluid at rest are of no use.
TEST(TimeStepper, FactorsThatNoLongerFitAreMadeAnew) {
  Channel run(PETSC_COMM_SELF, 1, 1e9);
  const auto every = run.march(TimeScheme::bdf1, 6, 1), never = run.march(TimeScheme::bdf1, 6, 1000);
  const int fluid = run.disc.fluid_unknowns();
  EXPECT_GT(every.x[0].head(fluid).lpNorm<Eigen::Infinity>(), 50.0);
  EXPECT_LT((every.x[0] - never.x[0]).head(fluid).norm(), 1e-6 * every.x[0].head(fluid).norm());
}

/// A wall that drags the fluid along: what a step leaves over with its own velocity as the convecting one.
TEST(TimeStepper, TakesTheConvectingVelocityFromItsAnswerWhereAsked) {
  for (const int order : {1, 2}) {
    SCOPED_TRACE("order " + std::to_string(order));
    Channel run(PETSC_COMM_SELF, order, 1e7);
    const auto left_over = [&](double tolerance) {
      TimeStepper<2> stepper(run.disc, run.operators, TimeScheme::bdf1, dt, 1, run.timer, {}, {tolerance});
      State state = initial_state(run.disc);
      for (int k = 0; k < 3; ++k) stepper.advance(state);
      EXPECT_GT(stepper.convection_error(), 0.1);
      EXPECT_EQ(stepper.iterations() > 1, tolerance > 0);
      const auto& x = state.x[0];
      const Eigen::VectorXd convection = convection_of(run.disc, run.operators, x, x);
      Eigen::VectorXd sum = run.operators.mass * ((x - state.x[1]) / dt) + run.operators.physical * x +
                            run.operators.stabilisation * x + run.operators.damping * x +
                            run.operators.stiffness * state.d[0] + convection +
                            jumps_of(run.disc, run.operators, x, x) -
                            loads_at(run.disc, run.operators, state.time);
      constrain_rows(run.disc, sum);
      return sum.norm() / convection.norm();
    };
    EXPECT_GT(left_over(0), 0.05);
    EXPECT_LT(left_over(1e-4), 1e-3);
  }
}

class TimeStepperMpi : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Orders, TimeStepperMpi, testing::Values(1, 2));

/// On one rank a repetition; on two the whole assembly and solve in parallel against one rank alone.
TEST_P(TimeStepperMpi, AgreesWithOneRank) {
  Channel alone(PETSC_COMM_SELF, GetParam()), together(PETSC_COMM_WORLD, GetParam());
  int ranks = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  std::vector<int> owned(ranks, 0);
  for (const int owner : together.operators.ownership.owner) ++owned[owner];
  for (const int count : owned) EXPECT_NEAR(count, together.disc.unknowns() / ranks, 1);
  const auto one = alone.march(TimeScheme::bdf2, 6), all = together.march(TimeScheme::bdf2, 6);
  const int fluid = alone.disc.fluid_unknowns();
  EXPECT_LT((one.x[0] - all.x[0]).head(fluid).norm(), 1e-8 * one.x[0].head(fluid).norm());
  EXPECT_LT((one.d[0] - all.d[0]).norm(), 1e-9 * one.d[0].norm());
  EXPECT_GT(one.d[0].norm(), 0.0);

  TimeStepper<2> stepper_one(alone.disc, alone.operators, TimeScheme::bdf2, dt, 1, alone.timer);
  TimeStepper<2> stepper_all(together.disc, together.operators, TimeScheme::bdf2, dt, 1, together.timer);
  State state_one = one, state_all = all;
  stepper_one.advance(state_one);
  stepper_all.advance(state_all);
  const auto a = stepper_one.energy(state_one, stepper_one.residual(state_one)),
             b = stepper_all.energy(state_all, stepper_all.residual(state_all));
  for (const auto term :
       {&EnergyTerms::holder, &EnergyTerms::opening, &EnergyTerms::viscous, &EnergyTerms::stabilisation,
        &EnergyTerms::damping, &EnergyTerms::kinetic, &EnergyTerms::elastic})
    EXPECT_NEAR(a.*term, b.*term, 1e-6 * std::abs(a.*term));
  EXPECT_NE(a.holder, 0);
}

} // namespace
} // namespace undula::fom
