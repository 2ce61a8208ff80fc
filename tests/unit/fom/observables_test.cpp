// Observables of states written down by hand.
#include "fom/output/observables.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>

#include "tests/verification/support/channel_problem.hpp"

namespace undula::fom {
namespace {

using namespace verification;
using Sizes = ChannelSizes;
constexpr double pi = std::numbers::pi;

/// A closed box of 1 x 0.6 cm with a free plate, walls all round; `lid` moves the top.
struct Box {
  explicit Box(bool with_plate, Space space = Space::plane) {
    auto problem = channel_with_plate(space);
    if (!with_plate) problem.solids.clear();
    for (auto& [name, condition] : problem.boundary) {
      condition = {};
      condition.velocity = [](const Point<2>& x, double) { return Point<2>(7 * x[1], 0); };
    }
    problem.pin_pressure = true;
    disc = discretise(std::move(problem), CutOptions{});
    operators = build_operators(disc, PETSC_COMM_SELF, timer);
    plan = plan_observation(disc, 11);
    stepper.emplace(disc, operators, TimeScheme::bdf1, 1e-3, 1, timer);
  }
  /// What is seen when, after a step, fluid and plate are as given.
  Observation see(const Eigen::VectorXd& x, const Eigen::VectorXd& d) {
    State state = initial_state(disc);
    stepper->advance(state);
    state.x[0] = x;
    state.d[0] = d;
    return observe(disc, operators, *stepper, plan, state);
  }
  Eigen::VectorXd nothing() const { return Eigen::VectorXd::Zero(disc.unknowns()); }
  Eigen::VectorXd displaced(const std::function<Point<2>(const Point<2>&)>& field) const {
    Eigen::VectorXd d = interpolate_velocity(disc, field);
    d.head(disc.fluid_unknowns()).setZero();
    return d;
  }
  PhaseTimer timer;
  Discretisation<2> disc;
  Operators<2> operators;
  ObservationPlan<2> plan;
  std::optional<TimeStepper<2>> stepper;
};

TEST(Clearance, IsTheGapLeftByTheDisplacedPlate) {
  Box box(true);
  const auto clearance = [&](const Point<2>& shift) {
    return box.see(box.nothing(), box.displaced([&](const Point<2>&) { return shift; })).clearance_min;
  };
  EXPECT_NEAR(clearance({0, 0}), 1 - Sizes::plate_outer, 1e-14);
  EXPECT_NEAR(clearance({0, 0.15}), Sizes::height - Sizes::plate_high - 0.15, 1e-14);
  EXPECT_NEAR(clearance({0, -0.2}), Sizes::plate_low - 0.2, 1e-14);
  EXPECT_NEAR(clearance({0.19, 0}), 0.01, 1e-14);
  EXPECT_NEAR(clearance({0, -0.3}), Sizes::plate_low - 0.3, 1e-14); // through the wall: negative
}

TEST(Clearance, IsCountedInElementsWhereSolidsMoveThroughThem) {
  Box still(true), moving(true);
  moving.disc.interface_moves = true; // before the first step: the matrix has more entries
  const auto elements = [](Box& box, const Point<2>& shift) {
    return box.see(box.nothing(), box.displaced([&](const Point<2>&) { return shift; })).film_elements;
  };
  EXPECT_TRUE(std::isnan(elements(still, {0, 0}))); // the film has the elements that it has at rest
  constexpr double height = Sizes::height / 9, width = Sizes::radius / 12;
  EXPECT_NEAR(elements(moving, {0, 0.15}), (Sizes::height - Sizes::plate_high - 0.15) / height, 1e-12);
  EXPECT_NEAR(elements(moving, {0, -0.2}), (Sizes::plate_low - 0.2) / height, 1e-12);
  EXPECT_NEAR(elements(moving, {0.19, 0}), 0.01 / width, 1e-12);
}

TEST(WallShear, IsThatOfCouetteFlow) {
  Box box(false);
  const auto couette =
      interpolate_velocity(box.disc, [](const Point<2>& x) { return Point<2>(7 * x[1], 0); });
  const auto seen = box.see(couette, box.nothing());
  EXPECT_NEAR(seen.wall_shear_max, 0.05 * 7, 1e-12);
  EXPECT_NEAR(seen.wall_shear_mean, 0.05 * 7, 1e-12); // the same on all four sides of a linear shear flow
  EXPECT_NEAR(seen.speed_max, 7 * Sizes::height, 1e-12);
}

/// Only the symmetric gradient counts.
TEST(WallShear, VanishesInRigidRotation) {
  Box box(false);
  const auto turning =
      interpolate_velocity(box.disc, [](const Point<2>& x) { return Point<2>(-3 * x[1], 3 * x[0]); });
  EXPECT_NEAR(box.see(turning, box.nothing()).wall_shear_max, 0, 1e-12);
}

TEST(MembraneProbes, ReadTheAxialDisplacementOfTheMidPlane) {
  Box box(true, Space::axisymmetric);
  const auto bent =
      box.displaced([](const Point<2>& x) { return Point<2>(5.0, x[0] * x[0] + 0.1 * x[0] * x[1]); });
  const Eigen::VectorXd axial = box.plan.probes.axial_displacement(bent);
  const double middle = 0.5 * (Sizes::plate_low + Sizes::plate_high);
  ASSERT_EQ(axial.size(), 11);
  for (int k = 0; k < 11; ++k) {
    const double r = box.plan.probes.radius[k];
    EXPECT_NEAR(r, Sizes::plate_inner + 0.5 * k / 10, 1e-6);
    EXPECT_NEAR(axial[k], r * r + 0.1 * r * middle, 1e-13);
  }
  const auto seen = box.see(box.nothing(), bent);
  EXPECT_NEAR(seen.tip_displacement, 0.09 + 0.03 * middle, 1e-6);
  EXPECT_NEAR(seen.holder.displacement, 0.64 + 0.08 * middle, 1e-6);
}

TEST(Flow, IsPositiveOutOfTheOutletAndIntoTheInlet) {
  PhaseTimer timer;
  const auto disc = discretise(channel_with_plate(Space::axisymmetric), CutOptions{});
  const auto operators = build_operators(disc, PETSC_COMM_SELF, timer);
  const auto plan = plan_observation(disc, 3);
  TimeStepper<2> stepper(disc, operators, TimeScheme::bdf1, 1e-3, 1, timer);
  State state = initial_state(disc);
  stepper.advance(state);
  state.x[0] = interpolate_velocity(disc, [](const Point<2>& x) { return Point<2>(0, -2 * (1 + x[1])); });
  const auto seen = observe(disc, operators, stepper, plan, state);
  EXPECT_NEAR(seen.outflow, 2 * pi, 1e-12);
  EXPECT_NEAR(seen.inflow, 2 * pi * (1 + Sizes::height), 1e-12);
  EXPECT_NEAR(seen.hydraulic_power, 500 * 2 * pi, 1e-9);
  EXPECT_EQ(seen.step, 1);
}

} // namespace
} // namespace undula::fom
