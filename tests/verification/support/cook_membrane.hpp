// Cook's membrane: the tapered panel (0,0), (48,44), (48,60), (0,44), clamped on the left, sheared by a
// uniform traction on the right. The customary data, in any consistent units.
#pragma once

#include "tests/verification/support/solid_meshes.hpp"

namespace undula::verification {

/// The panel on a mesh of the unit square.
inline SolidBody<2> cook_panel(SimplexMesh<2> unit_square, double poisson) {
  constexpr double shear_modulus = 80.1938;
  SolidBody<2> body;
  body.mesh = std::move(unit_square);
  for (auto& x : body.mesh.points) x = Point<2>(48 * x[0], 44 * x[0] + x[1] * (44 - 28 * x[0]));
  body.properties = {1.0, 2 * (1 + poisson) * shear_modulus, poisson, 0.0};
  body.imposed = [](const Point<2>& x) { return x[0] == 0; };
  return body;
}

/// The traction on its right side, by unknown: 1/6, 4/6, 1/6 of the load of each quadratic edge.
inline Eigen::VectorXd cook_load(const Discretisation<2>& disc) {
  constexpr double end_load = 100.0;
  const auto& mesh = disc.problem.solids[0].mesh;
  Eigen::VectorXd load = Eigen::VectorXd::Zero(disc.unknowns());
  for (const auto& facet : mesh.boundary) {
    if (facet.tag != 1) continue; // the right side
    const auto &a = mesh.points[facet.points[0]], &b = mesh.points[facet.points[1]];
    const double force = end_load * (b - a).norm() / 16;
    for (const int corner : facet.points) load[disc.solid_unknown(0, corner, 1)] += force / 6;
    load[disc.solid_unknown(0, node_at(disc, 0, 0.5 * (a + b)), 1)] += force * 4 / 6;
  }
  return load;
}

} // namespace undula::verification
