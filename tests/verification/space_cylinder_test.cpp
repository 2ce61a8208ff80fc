// DFG benchmark 3D-1Z: the steady flow past a cylinder between the walls of a square channel, Re 20.
#include <gtest/gtest.h>

#include <cstdio>

#include "fom/problem/default_weights.hpp"
#include "fom/space/velocity_element.hpp"
#include "fom/time/reaction.hpp"
#include "fom/time/steady.hpp"
#include "tests/verification/support/cylinder_channel.hpp"
#include "tests/verification/support/extruded_mesh.hpp"

namespace undula::verification {
namespace {

/// FeatFlow's values (Bayraktar, Mierka & Turek, Int. J. Comput. Sci. Eng. 7, 2012).
constexpr double drag_1z = 6.18533, drop_1z = 0.1710;
constexpr double upstream = 0.3; // cm; the plane mesh begins this far behind the inlet

/// Both halves of the depth graded towards the walls.
std::vector<double> layers(int count) {
  std::vector<double> levels;
  for (int k = 0; k <= count; ++k)
    levels.push_back(0.5 * channel_height * (1 - std::cos(std::numbers::pi * k / count)));
  levels.front() = 0;
  levels.back() = channel_height;
  return levels;
}

/// The fitted mesh of the plane with the piece before it, from x = -0.3.
SimplexMesh<2> plane_mesh(int side) {
  auto mesh = fitted_cylinder_mesh(side, 0.08 / side);
  const int columns = static_cast<int>(std::ceil(0.7 * side * upstream / channel_height));
  // Points of the old inlet by height.
  std::vector<int> inlet;
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    if (std::abs(mesh.points[i][0]) < 1e-12) inlet.push_back(static_cast<int>(i));
  std::sort(inlet.begin(), inlet.end(), [&](int a, int b) { return mesh.points[a][1] < mesh.points[b][1]; });
  std::erase_if(mesh.boundary, [](const auto& facet) { return facet.tag == 2; });
  auto right = inlet;
  for (int column = 1; column <= columns; ++column) {
    std::vector<int> left;
    for (const int point : inlet) {
      left.push_back(static_cast<int>(mesh.points.size()));
      mesh.points.emplace_back(-upstream * column / columns, mesh.points[point][1]);
    }
    for (std::size_t row = 0; row + 1 < left.size(); ++row) {
      mesh.cells.push_back({left[row], right[row], right[row + 1]});
      mesh.cells.push_back({left[row], right[row + 1], left[row + 1]});
    }
    mesh.boundary.push_back({{left.front(), right.front()}, 1});
    mesh.boundary.push_back({{left.back(), right.back()}, 1});
    right = left;
  }
  for (std::size_t row = 0; row + 1 < right.size(); ++row)
    mesh.boundary.push_back({{right[row], right[row + 1]}, 2});
  return mesh;
}

double pressure_at(const Discretisation<3>& disc, const Eigen::VectorXd& x, const Point<3>& at) {
  for (int part = 0; part < static_cast<int>(disc.cut.parts.size()); ++part) {
    const auto lambda = barycentric_coordinates(disc.cut.mesh, disc.cut.parts[part].cell, at);
    if (lambda.minCoeff() >= -1e-9) return sample_pressure<3>(disc, part, lambda, x);
  }
  ADD_FAILURE() << "no fluid at " << at.transpose();
  return 0;
}

struct Coefficients {
  double drag = 0, lift = 0, drop = 0;
};

Coefficients past_cylinder(int side, int layer_count) {
  FsiProblem<3> problem;
  problem.fluid = {1, 1e-3};
  problem.stabilisation = derived_weights(0.45, 0.1);
  problem.background = extruded(plane_mesh(side), layers(layer_count), "front", "back");
  for (const auto& name : problem.background.boundary_names) problem.boundary[name];
  const double height = channel_height;
  problem.boundary["inlet"].velocity = [=](const Point<3>& x, double) -> Point<3> {
    return {16 * 0.45 * x[1] * x[2] * (height - x[1]) * (height - x[2]) / std::pow(height, 4), 0, 0};
  };
  problem.boundary["outlet"].kind = BoundaryCondition<3>::Kind::opening;
  problem.boundary["outlet"].opening = OpeningCondition::traction;
  const auto disc = discretise<3>(std::move(problem), CutOptions{});
  PhaseTimer timer;
  const auto operators = build_operators<3>(disc, MPI_COMM_SELF, timer);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(disc.unknowns());
  solve_steady<3>(disc, operators, 1e-5, 30, timer, x);
  const Point<3> force = force_on_boundary<3>(disc, steady_residual<3>(disc, operators, x), "cylinder");
  const double scale = 2 / (0.2 * 0.2 * 2 * cylinder_radius * height);
  Coefficients seen{scale * force[0], scale * force[1], 0};
  const double off = 1e-6, middle = 0.5 * height;
  seen.drop =
      pressure_at(disc, x, {0.15 - off, 0.2, middle}) - pressure_at(disc, x, {0.25 + off, 0.2, middle});
  std::printf("3D-1Z: %6d unknowns   C_D %.4f (%+.2f %%)   C_L %.4f   dp %.5f (%+.2f %%)\n", disc.unknowns(),
              seen.drag, 100 * (seen.drag / drag_1z - 1), seen.lift, seen.drop,
              100 * (seen.drop / drop_1z - 1));
  std::fflush(stdout);
  return seen;
}

/// Coarse: the drag comes near from above as the elements shrink.
TEST(SpaceCylinder, SteadyDrag) {
  const auto coarse = past_cylinder(6, 4), fine = past_cylinder(10, 6);
  EXPECT_NEAR(fine.drag / drag_1z, 1, 0.12);
  EXPECT_GT(coarse.drag - drag_1z, 3 * std::abs(fine.drag - drag_1z));
}

} // namespace
} // namespace undula::verification
