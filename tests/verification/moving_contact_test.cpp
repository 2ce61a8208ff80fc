// A block pressed onto a wall through the fluid: it comes to rest on the film of contact, and never passes.
#include <gtest/gtest.h>

#include <cstdio>

#include "fom/coupling/moving_stepper.hpp"
#include "fom/problem/default_weights.hpp"
#include "fom/scene/scene.hpp"
#include "rom/base/error.hpp"
#include "tests/verification/support/names.hpp"
#include "tests/verification/support/solid_meshes.hpp"

namespace undula::verification {
namespace {

constexpr double film = 0.08, stiffness = 100.0, thickness = 0.1, rest = 0.1;

struct Landing {
  double gap = 0;             ///< at the end, cm
  double lowest_gap = 0;      ///< of all steps
  double speed = 0;           ///< of the block at the end, cm/s
  int parts = 1;              ///< the most that a step was divided into
  double film_change = 0;     ///< the largest of all parts
  double operator_change = 0; ///< of the stiffness that the steppers share, dyn/cm
  double unbalanced = 0;      ///< of the last step's residual on free unknowns, as a part of the film's force
};

/// Lands a block of 0.6 x `thickness`, pushed down by `pressure` (dyn/cm^2, over its lower side).
Landing land(double pressure, double dt, int steps, double film_change = 0) {
  FsiProblem<2> problem;
  problem.fluid = {1.0, 0.05};
  problem.stabilisation = derived_weights(1.0, 0.1);
  problem.background = tensor_mesh(spaced(0, 1, 40), spaced(0, 0.5, 20));
  for (const auto& name : problem.background.boundary_names) problem.boundary[name];
  problem.pin_pressure = true;
  SolidBody<2> block;
  block.mesh = box({0.2, rest}, {0.8, rest + thickness}, 12, 2);
  block.properties = {1.5, 1e6, 0.3};
  block.body_force = [=](const Point<2>&, double) { return Point<2>(0, -pressure / thickness); };
  problem.solids.push_back(block);
  PhaseTimer timer;
  auto disc = discretise(std::move(problem), {});
  auto operators = build_operators(disc, MPI_COMM_SELF, timer);
  State state = initial_state(disc);
  TimeSettings settings;
  settings.motion.film_change = film_change;
  const ContactSettings contact{film, stiffness, 0};
  MovingStepper<2> stepper(disc, operators, Coupling::explicit_, settings, contact, dt, timer, state);
  const auto skin = prepare_contact(disc, contact);
  Landing landing;
  landing.lowest_gap = 1;
  for (int step = 0; step < steps; ++step) {
    stepper.advance(state);
    landing.gap = smallest_gap(skin, state.d[0].tail(disc.solid_unknowns()));
    landing.lowest_gap = std::min(landing.lowest_gap, landing.gap);
    landing.parts = std::max(landing.parts, stepper.report().parts);
    landing.film_change = std::max(landing.film_change, stepper.report().film_change);
  }
  landing.speed = state.x[0].tail(disc.solid_unknowns()).lpNorm<Eigen::Infinity>();
  landing.operator_change =
      (operators.stiffness - build_operators(disc, MPI_COMM_SELF, timer).stiffness).norm();
  Eigen::VectorXd residual = stepper.last_step().residual(state);
  for (int unknown = 0; unknown < disc.unknowns(); ++unknown)
    if (disc.is_constrained[unknown]) residual[unknown] = 0;
  landing.unbalanced = residual.norm() / (pressure * 0.6);
  std::printf("pressure %7.0f: gap %.5f (film alone %.5f), lowest %.5f, speed %.1e, parts %d\n", pressure,
              landing.gap, film / (1 + pressure / stiffness), landing.lowest_gap, landing.speed,
              landing.parts);
  return landing;
}

TEST(Contact, HoldsABlockOnItsFilm) {
  const auto landing = land(100.0, 5e-3, 120);
  EXPECT_LT(landing.speed, 0.02);
  EXPECT_NEAR(landing.gap, film / 2, 0.02 * film);
  // Contact is a term of the step: the operators stay those of the bodies, and the residual holds the film.
  EXPECT_EQ(landing.operator_change, 0);
  EXPECT_LT(landing.unbalanced, 1e-7);
}

/// A film that closes fast is followed in parts of the steps, as long as it does.
TEST(Contact, TakesStepsInPartsWhereAFilmClosesFast) {
  const auto plain = land(500.0, 5e-3, 60), careful = land(500.0, 5e-3, 60, 0.05);
  EXPECT_GT(plain.film_change, 0.1);
  EXPECT_GT(careful.parts, plain.parts);
  EXPECT_LT(careful.film_change, 0.5 * plain.film_change);
  EXPECT_NEAR(careful.gap, plain.gap, 0.05 * plain.gap);
}

/// Onto a film of half an element.
TEST(Contact, LetsNothingThroughTheWall) {
  const auto landing = land(500.0, 5e-3, 60);
  EXPECT_GT(landing.lowest_gap, 0);
  EXPECT_LT(landing.gap, 0.3 * film);
}

/// A blow that the film is far too soft for: the run stops and says so, before the solid has passed.
TEST(Contact, SaysWhereItCannotHold) {
  try {
    land(1e5, 5e-3, 60);
    FAIL() << "the film held";
  } catch (const NumericsError& error) {
    EXPECT_NE(std::string(error.what()).find("wall"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("step"), std::string::npos) << error.what();
  }
}

} // namespace
} // namespace undula::verification
