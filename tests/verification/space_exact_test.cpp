// In space: flows that the elements hold are met to rounding, on any cut; bodies that move as a whole or bend
// as a quadratic are met exactly, too.
#include <gtest/gtest.h>

#include "fom/time/reaction.hpp"
#include "fom/time/steady.hpp"
#include "fom/time/time_stepper.hpp"
#include "tests/verification/support/flow_errors.hpp"
#include "tests/verification/support/space_flow.hpp"

namespace undula::verification {
namespace {

class SpaceExact : public testing::TestWithParam<int> {};

SimplexMesh<3> block() {
  return turned_block({0.5, 0.35, 0.3}, {0.05, -0.1, 0.08}, 0.7, {1, 2, 3}, {2, 1, 1});
}

/// A plate much thinner than an element, across most of the cube.
SimplexMesh<3> thin_plate() {
  return turned_block({0.8, 0.7, 0.01}, {0.05, 0.02, 0.11}, 0.4, {1, 2, 0}, {4, 4, 1});
}

/// Largest difference of velocities from `velocity` and of pressures from `pressure`, over all fluid nodes;
/// pressures in parts of `pressure_scale`.
template <class Velocity, class Pressure>
void expect_flow(const Discretisation<3>& disc, const Eigen::VectorXd& x, Velocity&& velocity,
                 Pressure&& pressure, double pressure_scale, double tolerance) {
  double velocity_error = 0, pressure_error = 0;
  for (int node = 0; node < disc.velocity_nodes(); ++node) {
    const Point<3> at = disc.velocity_position(node);
    velocity_error =
        std::max(velocity_error, (x.segment<3>(disc.velocity_unknown(node, 0)) - velocity(at)).norm());
    if (node < disc.vertex_nodes())
      pressure_error = std::max(pressure_error, std::abs(x[disc.pressure_unknown(node)] - pressure(at)));
  }
  EXPECT_LT(velocity_error, tolerance);
  EXPECT_LT(pressure_error, tolerance * pressure_scale);
}

/// density * speed^2 + viscosity * speed / size of an element, of a speed of 1.
constexpr double density = 1.3, viscosity = 0.7, flow_pressure = density + viscosity / 0.5;

/// Up to the constant of the pressure, which is pinned to 0 at the first node.
auto pinned(const Discretisation<3>& disc, const Point<3>& slope) {
  const Point<3> origin = disc.velocity_position(0);
  return [origin, slope](const Point<3>& x) { return slope.dot(x - origin); };
}

Eigen::VectorXd steady(const Discretisation<3>& disc) {
  PhaseTimer timer;
  const auto operators = build_operators<3>(disc, MPI_COMM_SELF, timer);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(disc.unknowns());
  solve_steady<3>(disc, operators, 1e-13, 30, timer, x);
  return x;
}

FsiProblem<3> cut_cube(const VectorField<3>& velocity, SimplexMesh<3> solid, int order) {
  auto problem = enclosed(warped_cube(4), velocity);
  problem.fluid = {density, viscosity};
  problem.velocity_order = order;
  problem.stabilisation = derived_weights(1.0, 0.1, order);
  problem.solids.push_back(skin_with_velocity(std::move(solid), velocity));
  return problem;
}

/// The body moves along, and takes its momentum through the mesh.
TEST_P(SpaceExact, UniformFlow) {
  const VectorField<3> stream = [](const Point<3>&, double) { return Point<3>(0.3, -0.8, 0.5); };
  for (const auto& solid : {block(), thin_plate()}) {
    auto disc = discretise<3>(cut_cube(stream, solid, GetParam()), space_quadrature());
    disc.interface_moves = true;
    ASSERT_GT(disc.cut.interface.size(), 50u);
    expect_flow(
        disc, steady(disc), [&](const Point<3>& x) { return stream(x, 0); },
        [](const Point<3>&) { return 0.0; }, flow_pressure, 1e-12);
  }
}

TEST_P(SpaceExact, RigidRotationWithoutInertia) {
  const VectorField<3> turn = [](const Point<3>& x, double) -> Point<3> {
    return Point<3>(0.4, -0.2, 0.9).cross(x) + Point<3>(0.1, 0.2, 0.3);
  };
  for (const auto& solid : {block(), thin_plate()}) {
    auto problem = cut_cube(turn, solid, GetParam());
    problem.flow = FlowModel::stokes;
    const auto disc = discretise<3>(std::move(problem), space_quadrature());
    expect_flow(
        disc, steady(disc), [&](const Point<3>& x) { return turn(x, 0); },
        [](const Point<3>&) { return 0.0; }, flow_pressure, 1e-12);
  }
}

TEST_P(SpaceExact, HydrostaticsAroundABody) {
  const Point<3> gravity(0.15, -0.2, -0.9);
  auto problem = cut_cube({}, block(), GetParam());
  problem.body_force = [&](const Point<3>&, double) { return gravity; };
  const auto disc = discretise<3>(std::move(problem), space_quadrature());
  const auto x = steady(disc);
  expect_flow(
      disc, x, [](const Point<3>&) { return Point<3>(0, 0, 0); }, pinned(disc, gravity), 1, 1e-12);
  // Archimedes: the block's volume is 8 x 0.5 x 0.35 x 0.3.
  PhaseTimer timer;
  const auto operators = build_operators<3>(disc, MPI_COMM_SELF, timer);
  const Point<3> buoyancy = force_on_solid<3>(disc, operators, x, 0);
  EXPECT_LT((buoyancy + 8 * 0.5 * 0.35 * 0.3 * gravity).norm(), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(VelocityOrder, SpaceExact, testing::Values(1, 2));

} // namespace
} // namespace undula::verification
