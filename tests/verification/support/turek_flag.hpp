// The flag of the benchmark of Turek & Hron (2006): 0.35 long, 0.02 high, behind a cylinder of radius 0.05
// about (0.2, 0.2), held on the cylinder's arc; tip A = (0.6, 0.2). SI units; plane strain.
#pragma once

#include "tests/verification/support/solid_meshes.hpp"

namespace undula::verification {

inline const Point<2> flag_tip{0.6, 0.2};

/// `nx` x `ny` quadrilaterals (ny even), each split in two. `shear` modulus in Pa, nu = 0.4, density 1000. A
/// body force `gravity` (m/s^2) downwards.
inline Discretisation<2> turek_flag(int nx, int ny, double shear, double gravity, SolidModel model) {
  constexpr double radius = 0.05, density = 1000, poisson = 0.4;
  SolidBody<2> body;
  body.name = "flag";
  body.mesh = box({0, 0.19}, {1, 0.21}, nx, ny);
  for (auto& x : body.mesh.points) {
    const double left = 0.2 + std::sqrt(radius * radius - (x[1] - 0.2) * (x[1] - 0.2));
    x[0] = left + (0.6 - left) * x[0];
  }
  body.properties = {density, 2 * (1 + poisson) * shear, poisson, 0.0};
  body.model = model;
  // Mid-points of edges lie on chords, inside the circle.
  body.imposed = [](const Point<2>& x) { return (x - Point<2>(0.2, 0.2)).norm() < radius * (1 + 1e-9); };
  body.body_force = [gravity](const Point<2>&, double) { return Point<2>(0, -density * gravity); };
  return discretise(in_vacuo(Space::plane, std::move(body)), CutOptions{});
}

} // namespace undula::verification
