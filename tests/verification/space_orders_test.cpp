// Orders of convergence of the fluid in space by the flow of Ethier & Steinman: uncut, cut by a turned block,
// on a domain that a map moves, steady and in time; and how the skin's place in the elements counts.
#include <gtest/gtest.h>

#include <cstdio>

#include "fom/time/steady.hpp"
#include "fom/time/time_stepper.hpp"
#include "tests/verification/support/condition_number.hpp"
#include "tests/verification/support/flow_errors.hpp"
#include "tests/verification/support/space_flow.hpp"

namespace undula::verification {
namespace {

struct SpaceCase {
  const char* name;
  bool convects = false, cut = false, mapped = false;
  int order = 1;
};

/// Displacement of the domain's points, zero on its sides.
Point<3> moved_by(const Point<3>& x) {
  const Point<3> rest = Point<3>::Ones() - x.cwiseAbs2();
  return 0.12 * rest.prod() * Point<3>(1, -0.7, 0.5);
}

FlowErrors errors_of(const SpaceCase& what, int n) {
  const BeltramiFlow flow{what.convects ? 0.1 : 1.0};
  const auto place = [what](const Point<3>& x) -> Point<3> { return what.mapped ? x + moved_by(x) : x; };
  auto problem = enclosed(warped_cube(n), [=](const Point<3>& x, double) { return flow.at(x).velocity; });
  problem.flow = what.convects ? FlowModel::navier_stokes : FlowModel::stokes;
  problem.fluid = {1, flow.viscosity};
  problem.velocity_order = what.order;
  problem.stabilisation = derived_weights(what.convects ? 1.0 : 0.0, 1.0, what.order);
  problem.body_force = [=](const Point<3>& x, double) -> Point<3> {
    const auto exact = flow.at(x);
    const Point<3> friction = flow.viscosity * flow.decay * flow.decay * exact.velocity;
    return what.convects ? friction : Point<3>(friction + exact.pressure_gradient);
  };
  if (what.cut)
    problem.solids.push_back(
        skin_with_velocity(turned_block({0.5, 0.35, 0.3}, {0.05, -0.1, 0.08}, 0.7, {1, 2, 3}, {n, n, n}),
                           [=](const Point<3>& x, double) { return flow.at(place(x)).velocity; }));
  auto disc = discretise<3>(std::move(problem), space_quadrature(what.order == 2 ? 6 : 4));
  if (what.mapped) {
    for (const int point : disc.fluid_nodes.dof_point)
      disc.map.displacement.push_back(moved_by(disc.cut.mesh.points[static_cast<std::size_t>(point)]));
    disc.map.velocity.assign(disc.map.displacement.size(), Point<3>::Zero());
  }
  PhaseTimer timer;
  const auto operators = build_operators<3>(disc, MPI_COMM_SELF, timer);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(disc.unknowns());
  solve_steady<3>(disc, operators, 1e-6, 40, timer, x);
  return flow_errors_of<3>(disc, x, [&](const Point<3>& at) { return flow.at(at); });
}

/// Orders between two meshes, of u in L2 and H1 and p in L2.
FlowErrors orders_of(const SpaceCase& what, int coarse, int fine) {
  const auto first = errors_of(what, coarse), second = errors_of(what, fine);
  const auto order = [&](double a, double b) { return std::log(a / b) / std::log(double(fine) / coarse); };
  for (const auto& [n, e] : {std::pair(coarse, first), {fine, second}})
    std::printf("%-30s n = %2d   u L2 %.3e   u H1 %.3e   p L2 %.3e\n", what.name, n, e.velocity_l2,
                e.velocity_h1, e.pressure_l2);
  const FlowErrors orders{order(first.velocity_l2, second.velocity_l2),
                          order(first.velocity_h1, second.velocity_h1),
                          order(first.pressure_l2, second.pressure_l2)};
  std::printf("%-30s order    u L2 %.2f        u H1 %.2f        p L2 %.2f\n", what.name, orders.velocity_l2,
              orders.velocity_h1, orders.pressure_l2);
  return orders;
}

void expect_orders(const SpaceCase& what, int coarse, int fine, const FlowErrors& least) {
  const auto orders = orders_of(what, coarse, fine);
  EXPECT_GE(orders.velocity_l2, least.velocity_l2);
  EXPECT_GE(orders.velocity_h1, least.velocity_h1);
  EXPECT_GE(orders.pressure_l2, least.pressure_l2);
}

constexpr FlowErrors linear{1.8, 0.9, 1.0}, quadratic{2.8, 1.9, 1.9};
/// On meshes as coarse as these the ghost penalty of the pressure shows in the velocity.
constexpr FlowErrors quadratic_cut{1.9, 1.9, 1.9};

TEST(SpaceOrders, Uncut) { expect_orders({"uncut"}, 6, 12, linear); }
TEST(SpaceOrders, Convecting) { expect_orders({"convecting", true}, 6, 12, linear); }
TEST(SpaceOrders, Cut) { expect_orders({"cut", false, true}, 6, 12, linear); }
TEST(SpaceOrders, CutAndMoved) {
  expect_orders({"cut and moved by a map", false, true, true}, 6, 12, linear);
}
TEST(SpaceOrders, Quadratic) { expect_orders({"P2-P1", false, false, false, 2}, 4, 7, quadratic); }
TEST(SpaceOrders, QuadraticCut) { expect_orders({"cut, P2-P1", false, true, false, 2}, 5, 8, quadratic_cut); }
/// The closed form solves the equations: differences of it, and the pressure as Ethier & Steinman print it.
TEST(SpaceOrders, TheClosedFormSolvesTheEquations) {
  const BeltramiFlow flow{0.3};
  const double a = flow.growth, d = flow.decay, step = 1e-4, t = 0.2;
  for (const Point<3>& x : {Point<3>(0.3, -0.5, 0.8), Point<3>(-0.7, 0.1, 0.2)}) {
    const auto here = flow.at(x, t);
    Eigen::Matrix3d gradient;
    Point<3> laplace = Point<3>::Zero();
    Point<3> slope;
    for (int j = 0; j < 3; ++j) {
      const Point<3> e = step * Point<3>::Unit(j);
      const auto up = flow.at(x + e, t), down = flow.at(x - e, t);
      gradient.col(j) = (up.velocity - down.velocity) / (2 * step);
      slope[j] = (up.pressure - down.pressure) / (2 * step);
      laplace += (up.velocity - 2 * here.velocity + down.velocity) / (step * step);
    }
    EXPECT_LT((gradient - here.gradient).norm(), 1e-6);
    EXPECT_LT((slope - here.pressure_gradient).norm(), 1e-6);
    EXPECT_NEAR(here.gradient.trace(), 0, 1e-13);
    const Point<3> rate = (flow.at(x, t + step).velocity - flow.at(x, t - step).velocity) / (2 * step);
    EXPECT_LT((rate + gradient * here.velocity + slope - flow.viscosity * laplace).norm(), 1e-5);
    const double fallen = std::exp(-flow.viscosity * d * d * t);
    double printed = 0;
    for (int c = 0; c < 3; ++c) {
      const double u = x[c], v = x[(c + 1) % 3], w = x[(c + 2) % 3];
      printed +=
          std::exp(2 * a * u) + 2 * std::sin(a * u + d * v) * std::cos(a * w + d * u) * std::exp(a * (v + w));
    }
    EXPECT_NEAR(here.pressure, -0.5 * a * a * fallen * fallen * printed, 1e-12);
  }
}

/// In time, convecting, by BDF2 with steps in proportion to the elements.
FlowErrors errors_in_time(int order, int n, int steps) {
  const BeltramiFlow flow{0.1};
  const double end = 0.2;
  auto problem =
      enclosed(warped_cube(n), [=](const Point<3>& x, double t) { return flow.at(x, t).velocity; });
  problem.fluid = {1, flow.viscosity};
  problem.velocity_order = order;
  problem.stabilisation = derived_weights(1.0, end / steps, order);
  const auto disc = discretise<3>(std::move(problem), space_quadrature());
  PhaseTimer timer;
  const auto operators = build_operators<3>(disc, MPI_COMM_SELF, timer);
  TimeStepper<3> stepper(disc, operators, TimeScheme::bdf2, end / steps, 1, timer);
  State state = initial_state(disc);
  const auto exact = [&](double t) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(disc.unknowns());
    for (int node = 0; node < disc.velocity_nodes(); ++node)
      x.segment<3>(disc.velocity_unknown(node, 0)) = flow.at(disc.velocity_position(node), t).velocity;
    return x;
  };
  state.x[0] = exact(0);
  for (int step = 0; step < steps; ++step) stepper.advance(state);
  const auto errors =
      flow_errors_of<3>(disc, state.x[0], [&](const Point<3>& at) { return flow.at(at, end); });
  std::printf("in time, P%d, n = %2d, %2d steps: u L2 %.3e   u H1 %.3e   p L2 %.3e\n", order, n, steps,
              errors.velocity_l2, errors.velocity_h1, errors.pressure_l2);
  return errors;
}

void expect_orders_in_time(int order, int coarse, int fine, const FlowErrors& least) {
  const auto first = errors_in_time(order, coarse, 2 * coarse),
             second = errors_in_time(order, fine, 2 * fine);
  const double halvings = std::log2(static_cast<double>(fine) / coarse);
  EXPECT_GE(std::log2(first.velocity_l2 / second.velocity_l2) / halvings, least.velocity_l2);
  EXPECT_GE(std::log2(first.velocity_h1 / second.velocity_h1) / halvings, least.velocity_h1);
  EXPECT_GE(std::log2(first.pressure_l2 / second.pressure_l2) / halvings, least.pressure_l2);
}

TEST(SpaceOrders, InTime) { expect_orders_in_time(2, 3, 5, {1.8, 1.8, 1.8}); }
/// Condition of the scaled system with a block pushed by `offset` cells off the planes of the grid.
double condition_at(double offset, const StabilisationWeights& weights) {
  constexpr int n = 4;
  const double h = 2.0 / n;
  auto problem = enclosed(box_mesh({Point<3>::Constant(-1), Point<3>::Constant(1)}, {n, n, n}), {});
  problem.flow = FlowModel::stokes;
  problem.fluid = {1, 1};
  problem.stabilisation = weights;
  const Point<3> shift = offset * h * Point<3>(1, -0.5, 0.25);
  problem.solids.push_back(skin_with_velocity(turned_block({h, h, h}, shift, 0, {0, 0, 1}, {1, 1, 1}), {}));
  PhaseTimer timer;
  const auto disc = discretise<3>(std::move(problem), space_quadrature());
  const auto operators = build_operators<3>(disc, MPI_COMM_SELF, timer);
  Eigen::VectorXd scale = Eigen::VectorXd::Constant(disc.unknowns(), h);
  for (int node = 0; node < disc.vertex_nodes(); ++node) scale[disc.pressure_unknown(node)] = h * h * h;
  return condition_number(disc, operators, scale);
}

/// Largest condition over the places, divided by the median.
double spread(const char* name, const StabilisationWeights& weights) {
  std::vector<double> values;
  for (const double offset :
       {0.0, 1e-10, 1e-7, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 1 - 1e-4, 1 - 1e-7})
    values.push_back(condition_at(offset, weights));
  std::sort(values.begin(), values.end());
  const double median = values[values.size() / 2];
  std::printf("condition %-26s median %.3e, worst %.3g times that\n", name, median, values.back() / median);
  return values.back() / median;
}

TEST(SpaceOrders, ConditionIsBoundedByTheGhostPenalty) {
  auto weights = derived_weights(0.0, 1.0);
  EXPECT_LT(spread("defaults", weights), 2.5);
  weights.divergence = 0;
  weights.ghost_viscous = weights.ghost_inertial = weights.ghost_pressure = 0;
  EXPECT_GT(spread("without penalties at cuts", weights), 1e3);
}

} // namespace
} // namespace undula::verification
