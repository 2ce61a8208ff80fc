// Order in time of the two schemes on a convecting flow that starts from rest on a cut mesh.
#include <gtest/gtest.h>

#include <cstdio>

#include "fom/problem/default_weights.hpp"
#include "fom/time/time_stepper.hpp"
#include "tests/verification/support/flow_gallery.hpp"
#include "tests/verification/support/names.hpp"
#include "tests/verification/support/steady_flow.hpp"

namespace undula::verification {
namespace {

/// State at t = 1 of a flow around a fixed box that a growing, turning force drives between four walls.
Eigen::VectorXd stirred(TimeScheme scheme, int steps) {
  const TurnedBox box{{0.52, 0.47}, 0.21, 0.13, 0.4};
  ManufacturedFlow at_rest = plane_flow_around(box);
  at_rest.convects = true;
  at_rest.viscosity = 0.02;
  auto problem = manufactured_problem(at_rest, warped_square(12),
                                      turned_box(box.centre, box.half_x, box.half_y, box.angle, 4, 3),
                                      derived_weights(1.0, 0.1));
  for (auto& [name, condition] : problem.boundary) condition.velocity = nullptr;
  problem.body_force = [](const Point<2>& x, double t) -> Point<2> {
    return 20 * t * t * Point<2>(std::cos(2 * t) * x[1], -std::sin(3 * t) * x[0] * x[0]);
  };
  PhaseTimer timer;
  const auto disc = discretise<2>(problem, {});
  const auto operators = build_operators<2>(disc, MPI_COMM_SELF, timer);
  TimeStepper<2> stepper(disc, operators, scheme, 1.0 / steps, 1, timer);
  auto state = initial_state(disc);
  while (state.step < steps) stepper.advance(state);
  return state.x[0];
}

TEST(FluidTime, SchemesHaveTheirOrder) {
  for (const auto& [scheme, order] : {std::pair(TimeScheme::bdf1, 1.0), std::pair(TimeScheme::bdf2, 2.0)}) {
    std::vector<Eigen::VectorXd> states;
    for (const int steps : {20, 40, 80, 160}) states.push_back(stirred(scheme, steps));
    std::vector<double> changes;
    for (int k = 0; k < 3; ++k) changes.push_back((states[k + 1] - states[k]).norm() / states[3].norm());
    const double measured = std::log2(changes[1] / changes[2]);
    std::printf("BDF%.0f: change on halving the step %.2e %.2e %.2e, order %.2f\n", order, changes[0],
                changes[1], changes[2], measured);
    EXPECT_NEAR(measured, order, 0.15);
  }
}

} // namespace
} // namespace undula::verification
