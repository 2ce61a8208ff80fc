// Flows in space with a closed form, and problems that have them for an answer.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>

#include "fom/problem/default_weights.hpp"
#include "fom/problem/problem.hpp"
#include "geometry/cut/cut.hpp"
#include "geometry/mesh/box_mesh.hpp"
#include "tests/verification/support/names.hpp"

namespace undula::verification {

inline CutOptions space_quadrature(int degree = 3) {
  return {degree, std::max(degree, 5), degree, std::filesystem::temp_directory_path().string()};
}

/// Values at a point. gradient(i, j) = d u_i / d x_j.
struct SpaceSample {
  Point<3> velocity;
  Eigen::Matrix3d gradient;
  double pressure;
  Point<3> pressure_gradient;
};

/// The flow of Ethier & Steinman (Int. J. Numer. Meth. Fluids 19, 1994) in the cube (-1, 1)^3, density 1: its
/// vorticity is parallel to its velocity u, so that the Laplacian of u is -decay^2 u, the convection of u is
/// the gradient of |u|^2 / 2, and u falls as exp(-viscosity decay^2 t).
struct BeltramiFlow {
  double viscosity = 1;
  double growth = std::numbers::pi / 4, decay = std::numbers::pi / 2;

  SpaceSample at(const Point<3>& x, double t = 0) const {
    const double a = growth, d = decay, fallen = std::exp(-viscosity * d * d * t);
    SpaceSample sample;
    for (int c = 0; c < 3; ++c) {
      const int next = (c + 1) % 3, last = (c + 2) % 3;
      const double first = std::exp(a * x[c]), second = std::exp(a * x[last]);
      const double angle = a * x[next] + d * x[last], other = a * x[c] + d * x[next];
      const double factor = -a * fallen;
      sample.velocity[c] = factor * (first * std::sin(angle) + second * std::cos(other));
      sample.gradient(c, c) = factor * a * (first * std::sin(angle) - second * std::sin(other));
      sample.gradient(c, next) = factor * (a * first * std::cos(angle) - d * second * std::sin(other));
      sample.gradient(c, last) = factor * (d * first * std::cos(angle) + a * second * std::cos(other));
    }
    sample.pressure = -0.5 * sample.velocity.squaredNorm();
    sample.pressure_gradient = -sample.gradient.transpose() * sample.velocity;
    return sample;
  }
};

/// The cube (-1, 1)^3 of n^3 bricks, its inner points moved so that no two elements are alike.
inline SimplexMesh<3> warped_cube(int n) {
  auto mesh = box_mesh({Point<3>::Constant(-1), Point<3>::Constant(1)}, {n, n, n});
  for (auto& x : mesh.points) {
    const Point<3> s = (std::numbers::pi * x).array().sin(); // 0 on the sides
    x += 0.08 * Point<3>(s[0] * std::cos(x[1]), s[1] * std::cos(x[2] + 1), s[2] * std::sin(x[0] + 2));
  }
  return mesh;
}

/// A box with its corners at +-half about the origin, turned and moved.
inline SimplexMesh<3> turned_block(const Point<3>& half, const Point<3>& centre, double angle,
                                   const Point<3>& axis, const std::array<int, 3>& counts) {
  auto mesh = box_mesh({-half, half}, counts);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  for (auto& x : mesh.points) x = centre + turn * x;
  return mesh;
}

/// A body held throughout, whose skin moves with `velocity`: at rest, where the unknowns of solids are
/// displacements, what is imposed is this value itself.
inline SolidBody<3> skin_with_velocity(SimplexMesh<3> mesh, VectorField<3> velocity) {
  SolidBody<3> body;
  body.name = "solid";
  body.mesh = std::move(mesh);
  body.properties = {1, 1, 0.3, 0};
  body.imposed = [](const Point<3>&) { return true; };
  body.imposed_displacement = std::move(velocity);
  return body;
}

/// All sides with the velocity `velocity`; no fluid properties, weights or forces yet.
inline FsiProblem<3> enclosed(SimplexMesh<3> background, const VectorField<3>& velocity) {
  FsiProblem<3> problem;
  problem.background = std::move(background);
  problem.pin_pressure = true;
  for (const auto& name : problem.background.boundary_names) problem.boundary[name].velocity = velocity;
  return problem;
}

} // namespace undula::verification
