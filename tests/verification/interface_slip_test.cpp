// Navier's slip law on the skin of an immersed plate: Couette flow to rounding, Poiseuille flow between a
// wall and the plate and in a pipe at the orders of the space, for slip lengths from none to a skin without
// friction.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "fom/problem/default_weights.hpp"
#include "fom/time/reaction.hpp"
#include "fom/time/steady.hpp"
#include "tests/verification/support/names.hpp"
#include "tests/verification/support/steady_flow.hpp"

namespace undula::verification {
namespace {

constexpr double height = 0.63, viscosity = 0.7;

/// The half plane beyond a skin that crosses the unit square at `angle`, at the distance `height` from the
/// line where the flows below have their wall. With angle 0 that line is the side y = 0.
struct TiltedSkin {
  double angle = 0;
  Point<2> along() const { return {std::cos(angle), std::sin(angle)}; }
  Point<2> across() const { return {-std::sin(angle), std::cos(angle)}; }
  double from_wall(const Point<2>& x) const { return across().dot(x - point) + height; }
  SimplexMesh<2> plate() const { return turned_box(point + 0.5 * across(), 1.0, 0.5, angle, 8, 4); }
  static inline const Point<2> point{0.5, height};
};

/// The plate moves along itself with speed V: u = V y / (H + L), traction mu V / (H + L). Linear, so exact.
class SlipCouette : public testing::TestWithParam<double> {};

TEST_P(SlipCouette, IsExactToRounding) {
  constexpr double speed = 2.0, dt = 1e8; // far longer than the flow remembers
  const double slip = GetParam();
  for (const double angle : {0.0, 0.3}) {
    const TiltedSkin skin{angle};
    const double shear = speed / (height + slip);
    const auto velocity = [=](const Point<2>& x, double) -> Point<2> {
      return shear * skin.from_wall(x) * skin.along();
    };
    FsiProblem<2> problem;
    problem.flow = FlowModel::stokes;
    problem.fluid = {1.0, viscosity};
    problem.stabilisation = derived_weights(1.0, 1.0);
    problem.slip_length = slip;
    problem.background = warped_square(8);
    problem.pin_pressure = true;
    for (const auto& name : problem.background.boundary_names) problem.boundary[name].velocity = velocity;
    SolidBody<2> plate;
    plate.mesh = skin.plate();
    plate.properties = {1, 1, 0.3};
    plate.imposed = [](const Point<2>&) { return true; };
    plate.imposed_displacement = [=](const Point<2>&, double t) -> Point<2> {
      return speed * t * skin.along();
    };
    problem.solids.push_back(std::move(plate));
    const auto disc = discretise<2>(std::move(problem), CutOptions{});
    PhaseTimer timer;
    const auto operators = build_operators<2>(disc, MPI_COMM_SELF, timer);
    TimeStepper<2> stepper(disc, operators, TimeScheme::bdf1, dt, 1, timer);
    State state = initial_state(disc);
    stepper.advance(state);
    stepper.advance(state);

    const auto positions = unknown_positions(disc);
    double error = 0, wetted = 0;
    for (int i = 0; i < disc.fluid_unknowns(); i += 3)
      error = std::max(error, (state.x[0].segment<2>(i) - velocity(positions[i], 0)).norm());
    for (const auto& piece : disc.cut.interface)
      for (int q = piece.quadrature_begin; q < piece.quadrature_end; ++q)
        wetted += disc.cut.interface_quadrature.weights[q];
    const Point<2> drag = -viscosity * shear * wetted * skin.along();
    const Point<2> force = force_on_solid(disc, operators, state.x[0], 0);
    const double scale = viscosity * speed / height * wetted;
    std::printf("Couette, slip length %.0e, angle %.1f: velocity error %.1e, drag error %.1e\n", slip, angle,
                error / speed, (force - drag).norm() / scale);
    EXPECT_LT(error, 1e-11 * speed);
    EXPECT_LT((force - drag).norm(), 1e-11 * scale);
  }
}

INSTANTIATE_TEST_SUITE_P(Lengths, SlipCouette, testing::Values(0.0, 1e-8, 1e-2, 0.3, 1e2, 1e8));

/// u = G y (A - y) / (2 mu), A = H (H + 2 L) / (H + L), between the wall and the plate at rest.
ManufacturedFlow slip_poiseuille(const TiltedSkin& skin, double slip) {
  ManufacturedFlow flow;
  flow.viscosity = viscosity;
  const double far = height * (height + 2 * slip) / (height + slip), half = 0.5 / viscosity;
  const Point<2> e = skin.along(), m = skin.across(), at = skin.point;
  flow.stream = [=](const Jet& x, const Jet& y) {
    const Jet s = m[0] * (x - Jet(at[0])) + m[1] * (y - Jet(at[1])) + Jet(height);
    return half * s * s * (Jet(0.5 * far) - (1.0 / 3) * s);
  };
  flow.pressure = [=](const Jet& x, const Jet& y) { return -e[0] * x - e[1] * y; };
  return flow;
}

/// u = G (R^2 + 2 R L - r^2) / (4 mu) in a pipe of radius R, here `height`.
ManufacturedFlow slip_pipe(double slip) {
  ManufacturedFlow flow;
  flow.space = Space::axisymmetric;
  flow.viscosity = viscosity;
  flow.stream = [=](const Jet& r, const Jet&) {
    return (0.25 / viscosity) * (Jet(0.5 * height * (height + 2 * slip)) - 0.25 * r * r);
  };
  flow.pressure = [](const Jet&, const Jet& z) { return -z; };
  return flow;
}

void expect_orders(const char* name, const ManufacturedFlow& flow, const SimplexMesh<2>& plate, double slip) {
  std::vector<FlowErrors> errors;
  for (const int n : {8, 16, 32}) {
    auto problem = manufactured_problem(flow, warped_square(n), plate, derived_weights(1.0, 1.0));
    problem.slip_length = slip;
    errors.push_back(solve_manufactured(flow, problem));
    std::printf("%s, slip length %.0e, n = %2d: u L2 %.3e   u H1 %.3e   p L2 %.3e\n", name, slip, n,
                errors.back().velocity_l2, errors.back().velocity_h1, errors.back().pressure_l2);
  }
  const auto order = [&](double FlowErrors::*error) {
    return std::log2(errors[1].*error / errors[2].*error);
  };
  const double velocity = order(&FlowErrors::velocity_l2), gradient = order(&FlowErrors::velocity_h1);
  const double pressure = order(&FlowErrors::pressure_l2);
  std::printf("%s, slip length %.0e: orders %.2f, %.2f, %.2f\n", name, slip, velocity, gradient, pressure);
  EXPECT_GT(velocity, 1.8);
  EXPECT_GT(gradient, 0.9);
  EXPECT_GT(pressure, 1.0);
}

class SlipPoiseuille : public testing::TestWithParam<double> {};

TEST_P(SlipPoiseuille, HasTheOrdersOfTheSpaceInPlaneChannels) {
  const TiltedSkin skin{0.3};
  expect_orders("channel", slip_poiseuille(skin, GetParam()), skin.plate(), GetParam());
}

TEST_P(SlipPoiseuille, HasTheOrdersOfTheSpaceInPipes) {
  const auto wall = turned_box({height + 0.25, 0.5}, 0.25, 0.7, 0, 3, 8);
  expect_orders("pipe", slip_pipe(GetParam()), wall, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Lengths, SlipPoiseuille, testing::Values(0.0, 1e-3, 0.1, 2.0));

/// Between the limits: for short lengths the flow leaves that without slip in proportion to the length, for
/// long ones that without friction in proportion to its inverse.
TEST(Slip, TendsToNoSlipAndToNoFriction) {
  const TiltedSkin skin{0.3};
  const auto flow = slip_poiseuille(skin, 0);
  const auto solve = [&](double slip) {
    auto problem = manufactured_problem(flow, warped_square(12), skin.plate(), derived_weights(1.0, 1.0));
    problem.slip_length = slip;
    const auto disc = discretise<2>(std::move(problem), CutOptions{});
    PhaseTimer timer;
    const auto operators = build_operators<2>(disc, MPI_COMM_SELF, timer);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(disc.unknowns());
    solve_steady<2>(disc, operators, 1e-12, 10, timer, x);
    return x;
  };
  const Eigen::VectorXd stuck = solve(0), free = solve(1e12);
  const auto distance = [&](const Eigen::VectorXd& limit, double slip) {
    return (solve(slip) - limit).norm() / stuck.norm();
  };
  const double near_stuck = distance(stuck, 1e-5), near_free = distance(free, 1e5);
  std::printf("distance from no slip %.2e at 1e-5, from no friction %.2e at 1e5, between them %.2e\n",
              near_stuck, near_free, (free - stuck).norm() / stuck.norm());
  EXPECT_GT((free - stuck).norm(), 0.1 * stuck.norm());
  EXPECT_NEAR(near_stuck / distance(stuck, 1e-6), 10, 0.1);
  EXPECT_NEAR(near_free / distance(free, 1e6), 10, 0.1);
}

} // namespace
} // namespace undula::verification
