// Motion of the fluid's domain: the ALE map from the domain at rest, x = X + displacement(X).
#pragma once

#include <vector>

#include "fom/fom.hpp"
#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::fom {

/// Nodal (P1) values on the fluid nodes of a cut. Empty: the identity.
template <int dim>
struct DomainMap {
  std::vector<Point<dim>> displacement; ///< by fluid node, cm
  std::vector<Point<dim>> velocity;     ///< its rate, cm/s
  bool is_identity() const { return displacement.empty(); }
};

} // namespace undula::fom
