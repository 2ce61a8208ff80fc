// The square duct, cut out of a mesh that is turned against it.
#include <gtest/gtest.h>

#include <cstdio>

#include "fom/time/steady.hpp"
#include "fom/time/time_stepper.hpp"
#include "tests/verification/support/flow_errors.hpp"
#include "tests/verification/support/space_flow.hpp"

namespace undula::verification {
namespace {

// Flow and greatest velocity of a square duct of side a under the pressure gradient G: the coefficients of
// G a^4 / viscosity and of G a^2 / viscosity, from the series of the torsion of a square bar.
constexpr double duct_flow = 0.0351442543, duct_peak = 0.0736710552;

/// Around a square hole of side 1 about the z axis, turned by `angle`: eight blocks, farther than the domain.
SimplexMesh<3> duct_walls(double angle) {
  SimplexMesh<3> walls;
  constexpr double inner = 0.5, outer = 1.5, low = -0.5, high = 1.5;
  const double ends[] = {-outer, -inner, inner, outer};
  auto frame = box_mesh({{0, 0, 0}, {3, 3, 1}}, {3, 3, 1});
  const double c = std::cos(angle), s = std::sin(angle);
  for (const auto& x : frame.points) {
    const Point<2> at(ends[std::lround(x[0])], ends[std::lround(x[1])]);
    walls.points.emplace_back(c * at[0] - s * at[1], s * at[0] + c * at[1], low + (high - low) * x[2]);
  }
  for (const auto& cell : frame.cells) {
    Point<3> centre = Point<3>::Zero();
    for (const int point : cell) centre += frame.points[static_cast<std::size_t>(point)] / 4;
    const bool in_duct = centre[0] > 1 && centre[0] < 2 && centre[1] > 1 && centre[1] < 2;
    if (!in_duct) walls.cells.push_back(cell);
  }
  return walls;
}

struct DuctFlow {
  double flow = 0, peak = 0; ///< over the exact ones
};

DuctFlow through_duct(int cells_per_side, double angle, int order = 1) {
  const double h = 1.0 / cells_per_side, half = 0.5 * (std::abs(std::cos(angle)) + std::abs(std::sin(angle)));
  const int across = 2 * static_cast<int>(std::ceil(half / h + 0.3));
  const double side = 0.5 * across * h, length = h, drop = 3.0 * length;
  FsiProblem<3> problem;
  problem.flow = FlowModel::stokes;
  problem.fluid = {1, 0.5};
  problem.velocity_order = order;
  problem.stabilisation = derived_weights(0.0, 1.0, order);
  problem.background = box_mesh({{-side, -side, 0}, {side, side, length}}, {across, across, 1});
  for (const auto& name : problem.background.boundary_names) problem.boundary[name];
  for (const char* name : {"z_low", "z_high"})
    problem.boundary[name].kind = BoundaryCondition<3>::Kind::opening;
  problem.boundary["z_low"].pressure = [=](double) { return drop; };
  problem.solids.push_back(skin_with_velocity(duct_walls(angle), {}));
  const auto disc = discretise<3>(std::move(problem), space_quadrature(order == 2 ? 6 : 3));
  PhaseTimer timer;
  const auto operators = build_operators<3>(disc, MPI_COMM_SELF, timer);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(disc.unknowns());
  solve_steady<3>(disc, operators, 1e-9, 2, timer, x);
  const double gradient = drop / length;
  DuctFlow duct;
  duct.flow = operators.openings.at("z_high").dot(x) / (duct_flow * gradient / 0.5);
  double fastest = 0;
  for (int node = 0; node < disc.velocity_nodes(); ++node)
    fastest = std::max(fastest, x[disc.velocity_unknown(node, 2)]);
  duct.peak = fastest / (duct_peak * gradient / 0.5);
  std::printf(
      "duct, order %d, %2d cells per side: %6d unknowns, %5d cells cut, flow %.5f, peak %.5f of the exact\n",
      order, cells_per_side, disc.unknowns(), disc.cut.filtered_cells + disc.cut.exact_cells, duct.flow,
      duct.peak);
  return duct;
}

TEST(SpaceDuct, FlowOfATurnedDuct) {
  const auto coarse = through_duct(12, 0.35), middle = through_duct(24, 0.35), fine = through_duct(32, 0.35);
  EXPECT_GT(std::log2(std::abs((coarse.flow - 1) / (middle.flow - 1))), 1.8);
  EXPECT_NEAR(middle.peak, 1, 0.005);
  EXPECT_NEAR(fine.flow, 1, 0.005);
}

TEST(SpaceDuct, QuadraticVelocity) { EXPECT_NEAR(through_duct(12, 0.35, 2).flow, 1, 0.001); }

} // namespace
} // namespace undula::verification
