// A holder driven by a voltage in one step of finite elements: its equation, with every coupling and solid.
#include <gtest/gtest.h>

#include "fom/coupling/moving_stepper.hpp"
#include "fom/time/holder_step.hpp"
#include "tests/verification/support/channel_problem.hpp"

namespace undula::fom {
namespace {

using namespace verification;
using Sizes = ChannelSizes;
constexpr double dt = 1.0 / (Sizes::frequency * 64);

DrivenHolder holder(double stop = 0) {
  DrivenHolder driven;
  driven.actuator.force_per_volt = 100; // dyn/V
  driven.actuator.moving_mass = 0.3;
  driven.actuator.stiffness = 3e5;
  driven.actuator.damping = 50;
  driven.actuator.stop = stop;
  driven.actuator.stop_stiffness = stop > 0 ? 2e7 : 0;
  driven.voltage = [](double t) { return 60 * std::sin(2 * std::numbers::pi * Sizes::frequency * t); };
  return driven;
}

struct Channel {
  explicit Channel(SolidModel model, std::optional<DrivenHolder> driven, MPI_Comm comm = PETSC_COMM_SELF) {
    auto problem = channel_with_plate(Space::axisymmetric);
    problem.solids[0].model = model;
    problem.holder = std::move(driven);
    disc = discretise(std::move(problem), CutOptions{});
    operators = build_operators(disc, comm, timer);
  }
  PhaseTimer timer;
  Discretisation<2> disc;
  Operators<2> operators;
};

/// What is left of m w'' + c w' + k w + stop(w) + F = g V at the end of a step, as a part of the largest
/// term.
double left_over(const Discretisation<2>& disc, const Eigen::VectorXd& residual, const State& state,
                 const State& before, int step) {
  const auto& actuator = disc.problem.holder->actuator;
  const auto alpha = bdf_coefficients(TimeScheme::bdf2, step);
  const auto at = [&](const Eigen::VectorXd& values) { // counted from the solids' first unknown
    return values.tail(disc.solid_unknowns())[disc.joined.front() - disc.fluid_unknowns()];
  };
  double reaction = 0;
  for (const auto& node : disc.imposed) reaction += residual[node.unknown + 1];
  const double inertia =
      actuator.moving_mass *
      (alpha[0] * at(state.x[0]) + alpha[1] * at(before.x[0]) + alpha[2] * at(before.x[1])) / dt;
  const double resistance = holder_resistance(actuator, at(state.d[0]), at(state.x[0])).force;
  const double force = voltage_force(actuator, disc.problem.holder->voltage(state.time));
  const double largest =
      std::max({std::abs(inertia), std::abs(resistance), std::abs(force), std::abs(reaction)});
  EXPECT_GT(std::abs(reaction), 1e-3 * largest);
  return std::abs(inertia + resistance + reaction - force) / largest;
}

void expect_rigid(const Discretisation<2>& disc, const State& state) {
  for (const auto& values : {state.x[0], state.d[0]}) {
    for (const int unknown : disc.joined) {
      EXPECT_NEAR(values[unknown], values[disc.joined.front()], 1e-9 * std::abs(values[unknown]));
      EXPECT_NEAR(values[unknown - 1], 0, 1e-14);
    }
  }
}

TEST(DrivenHolder, ObeysItsEquationInEveryStep) {
  for (const SolidModel model : {SolidModel::linear, SolidModel::neo_hookean}) {
    for (const double stop : {0.0, 0.004}) {
      SCOPED_TRACE(stop);
      Channel run(model, holder(stop));
      TimeStepper<2> stepper(run.disc, run.operators, TimeScheme::bdf2, dt, 1, run.timer);
      State state = initial_state(run.disc);
      double greatest = 0;
      for (int step = 1; step <= 40; ++step) {
        const State before = state;
        stepper.advance(state);
        const auto residual = stepper.residual(state);
        EXPECT_LT(left_over(run.disc, residual, state, before, step), 1e-6) << "step " << step;
        greatest = std::max(greatest, std::abs(state.d[0][run.disc.joined.front()]));
        for (int unknown = 0; unknown < run.disc.unknowns(); ++unknown) {
          if (!run.disc.is_constrained[unknown]) {
            EXPECT_NEAR(residual[unknown], 0, 1e-2); // dyn; the holder's force is 1e3 to 1e4
          }
        }
      }
      expect_rigid(run.disc, state);
      if (stop > 0) {
        EXPECT_GT(greatest, stop);
        EXPECT_LT(greatest, 1.2 * stop);
      } else {
        EXPECT_GT(greatest, 0.006);
      }
    }
  }
}

// The way that a driven holder went, imposed, gives the same flow and the same membrane.
TEST(DrivenHolder, GoesWhereTheImposedMotionGivesTheSame) {
  for (const SolidModel model : {SolidModel::linear, SolidModel::neo_hookean}) {
    Channel driven(model, holder()), imposed(model, std::nullopt);
    double place = 0;
    imposed.disc.problem.solids[0].imposed_displacement = [&place](const Point<2>&, double) {
      return Point<2>(0.0, place);
    };
    TimeStepper<2> a(driven.disc, driven.operators, TimeScheme::bdf2, dt, 1, driven.timer);
    TimeStepper<2> b(imposed.disc, imposed.operators, TimeScheme::bdf2, dt, 1, imposed.timer);
    State state = initial_state(driven.disc), other = initial_state(imposed.disc);
    for (int step = 1; step <= 12; ++step) {
      a.advance(state);
      place = state.d[0][driven.disc.joined.front()];
      b.advance(other);
    }
    EXPECT_GT(std::abs(place), 1e-3);
    EXPECT_LT((state.x[0] - other.x[0]).norm(), 1e-7 * other.x[0].norm());
    EXPECT_LT((state.d[0] - other.d[0]).norm(), 1e-8 * other.d[0].norm());
    const auto here = a.energy(state, a.residual(state)), there = b.energy(other, b.residual(other));
    EXPECT_NEAR(here.holder, there.holder, 1e-6 * std::abs(there.holder));
  }
}

TEST(DrivenHolder, ObeysItsEquationWhereTheDomainMoves) {
  for (const Coupling coupling : {Coupling::explicit_, Coupling::implicit, Coupling::mapped}) {
    SCOPED_TRACE(static_cast<int>(coupling));
    Channel run(SolidModel::neo_hookean, holder());
    State state = initial_state(run.disc);
    SteppingSettings settings;
    settings.motion.tolerance = 1e-7;
    MovingStepper<2> stepper(run.disc, run.operators, coupling, settings, ContactSettings{}, dt, run.timer,
                             state);
    for (int step = 1; step <= 8; ++step) {
      const State before = state;
      stepper.advance(state);
      if (step == 1) continue; // BDF1; left_over takes the scheme by the step
      // The fluid's part of `before` is numbered otherwise: the holder's is asked for alone.
      EXPECT_LT(left_over(run.disc, stepper.last_step().residual(state), state, before, step), 1e-6)
          << "step " << step;
    }
    expect_rigid(run.disc, state);
    EXPECT_GT(std::abs(state.d[0][run.disc.joined.front()]), 1e-4);
  }
}

TEST(DrivenHolder, RestartsBitForBit) {
  Channel run(SolidModel::neo_hookean, holder());
  const auto march = [&](State state, int steps) {
    TimeStepper<2> stepper(run.disc, run.operators, TimeScheme::bdf2, dt, 1, run.timer);
    while (state.step < steps) stepper.advance(state);
    return state;
  };
  const State whole = march(initial_state(run.disc), 10);
  const State parts = march(march(initial_state(run.disc), 4), 10);
  EXPECT_EQ(whole.x[0], parts.x[0]);
  EXPECT_EQ(whole.d[0], parts.d[0]);
}

TEST(DrivenHolderMpi, AgreesWithOneRank) {
  Channel alone(SolidModel::neo_hookean, holder()),
      together(SolidModel::neo_hookean, holder(), PETSC_COMM_WORLD);
  const auto march = [](Channel& run) {
    TimeStepper<2> stepper(run.disc, run.operators, TimeScheme::bdf2, dt, 1, run.timer);
    State state = initial_state(run.disc);
    while (state.step < 6) stepper.advance(state);
    return state;
  };
  const State one = march(alone), all = march(together);
  const int fluid = alone.disc.fluid_unknowns();
  EXPECT_GT(std::abs(one.d[0][alone.disc.joined.front()]), 1e-5);
  EXPECT_LT((one.x[0] - all.x[0]).head(fluid).norm(), 1e-8 * one.x[0].head(fluid).norm());
  EXPECT_LT((one.d[0] - all.d[0]).norm(), 1e-8 * one.d[0].norm());
}

} // namespace
} // namespace undula::fom
