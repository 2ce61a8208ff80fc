// Newton's method inside the monolithic step: a plate under a nonlinear law on a moving holder in a channel.
#include <gtest/gtest.h>

#include "fom/time/time_stepper.hpp"
#include "rom/base/error.hpp"
#include "tests/verification/support/channel_problem.hpp"

namespace undula::fom {
namespace {

using namespace verification;
constexpr double dt = 1.0 / (ChannelSizes::frequency * 64);

/// `stroke` scales the motion of the holder and the head.
struct Channel {
  Channel(SolidModel model, double stroke, MPI_Comm comm = PETSC_COMM_SELF,
          Space space = Space::axisymmetric) {
    auto problem = channel_with_plate(space);
    auto& plate = problem.solids[0];
    plate.model = model;
    plate.properties.mass_damping = 20;
    plate.imposed_displacement = [stroke](const Point<2>&, double t) {
      return Point<2>(0.0, stroke * ChannelSizes::holder(t));
    };
    problem.boundary[outlet_name].pressure = [stroke](double) { return 500.0 * stroke; };
    disc = discretise(std::move(problem), CutOptions{});
    operators = build_operators(disc, comm, timer);
  }
  State march(int steps, int factor_every = 1, const NewtonSettings& newton = {}) {
    TimeStepper<2> stepper(disc, operators, TimeScheme::bdf2, dt, factor_every, timer, newton);
    State state = initial_state(disc);
    while (state.step < steps) stepper.advance(state);
    return state;
  }
  PhaseTimer timer;
  Discretisation<2> disc;
  Operators<2> operators;
};

constexpr auto laws = {SolidModel::saint_venant_kirchhoff, SolidModel::neo_hookean};

TEST(NonlinearStep, IsTheLinearStepForSmallMotionsOnly) {
  Channel linear_small(SolidModel::linear, 1e-5), linear_large(SolidModel::linear, 1);
  const auto small = linear_small.march(8), large = linear_large.march(8);
  for (const auto law : laws) {
    const auto tiny = Channel(law, 1e-5).march(8), wide = Channel(law, 1).march(8);
    EXPECT_LT((tiny.d[0] - small.d[0]).norm(), 1e-5 * small.d[0].norm());
    EXPECT_GT((wide.d[0] - large.d[0]).norm(), 1e-4 * large.d[0].norm());
  }
}

/// Holder, pressures and body forces do the work that fluid and solid take up, to the tolerance of Newton;
/// and nothing is left over but where motion is imposed.
TEST(NonlinearStep, BalancesForcesAndPowers) {
  for (const auto space : {Space::plane, Space::axisymmetric})
    for (const auto law : laws) {
      Channel run(law, 1, PETSC_COMM_SELF, space);
      TimeStepper<2> stepper(run.disc, run.operators, TimeScheme::bdf2, dt, 1, run.timer, {1e-11, 20});
      State state = initial_state(run.disc);
      Eigen::VectorXd oldest = state.x[1];
      for (int step = 0; step < 6; ++step) {
        oldest = state.x[1];
        stepper.advance(state);
        EXPECT_GE(stepper.iterations(), 1);
        EXPECT_LE(stepper.iterations(), 6);
      }
      const auto residual = stepper.residual(state);
      const auto solids = complete_response<2>(run.disc, run.operators, state.d[0], state.x[0], {}, false);
      double left = 0, held = 0;
      for (int u = run.disc.fluid_unknowns(); u < run.disc.unknowns(); ++u)
        (run.disc.is_constrained[u] ? held : left) += std::abs(residual[u]);
      EXPECT_GT(held, 0);
      EXPECT_LT(left, 1e-8 * solids.elastic.cwiseAbs().sum());

      const auto terms = stepper.energy(state, residual);
      const auto& x = state.x[0];
      const Eigen::VectorXd rate = (1.5 * x - 2 * state.x[1] + 0.5 * oldest) / dt;
      const double taken = terms.viscous + terms.stabilisation + terms.damping + terms.carried +
                           x.dot(run.operators.mass * rate) + x.dot(solids.elastic);
      const double scale = std::abs(terms.holder) + std::abs(terms.opening) + terms.viscous + terms.damping;
      EXPECT_NEAR(terms.holder + terms.opening + terms.body + terms.boundary, taken, 1e-7 * scale);
      EXPECT_DOUBLE_EQ(terms.elastic, solids.energy);
      EXPECT_GT(x.dot(solids.viscous), 0);
      EXPECT_GT(terms.damping, x.dot(solids.viscous)); // Rayleigh beside it
    }
}

TEST(NonlinearStep, KeepsTheLastGoodStateWhereNewtonFails) {
  Channel run(SolidModel::neo_hookean, 1);
  run.disc.problem.solids[0].imposed_displacement = [](const Point<2>&, double t) {
    return Point<2>(0.0, t > 3.5 * dt ? 40.0 : ChannelSizes::holder(t)); // torn away in one step
  };
  TimeStepper<2> stepper(run.disc, run.operators, TimeScheme::bdf2, dt, 1, run.timer);
  State state = initial_state(run.disc);
  while (state.step < 3) stepper.advance(state);
  const State good = state;
  try {
    stepper.advance(state);
    FAIL() << "no error";
  } catch (const NumericsError& error) {
    const std::string message = error.what();
    for (const char* part : {"Newton", "iteration", "step 4", "t = ", "smaller"})
      EXPECT_NE(message.find(part), std::string::npos) << message;
  }
  EXPECT_EQ(state.step, 3);
  EXPECT_EQ(state.time, good.time);
  for (const int level : {0, 1}) {
    EXPECT_TRUE(state.x[level] == good.x[level]);
    EXPECT_TRUE(state.d[level] == good.d[level]);
  }
}

TEST(NonlinearStep, KeepsAFactorisationWithoutChangingTheAnswer) {
  Channel run(SolidModel::neo_hookean, 1);
  const auto every = run.march(6, 1), fifth = run.march(6, 5);
  EXPECT_LT((every.d[0] - fifth.d[0]).norm(), 1e-7 * every.d[0].norm());
}

TEST(NonlinearStepMpi, AgreesWithOneRank) {
  Channel alone(SolidModel::neo_hookean, 1, PETSC_COMM_SELF),
      together(SolidModel::neo_hookean, 1, PETSC_COMM_WORLD);
  const auto one = alone.march(4), all = together.march(4);
  EXPECT_GT(one.d[0].norm(), 0.0);
  EXPECT_LT((one.d[0] - all.d[0]).norm(), 1e-8 * one.d[0].norm());
}

} // namespace
} // namespace undula::fom
