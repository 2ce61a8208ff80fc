// Potential flow through a part of a mesh: what a channel's inertia and laminar friction come to.
#pragma once

#include <functional>
#include <string>

#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::geometry {

/// A channel between an opening and the rest of the domain.
struct PassageFlow {
  double inertance = 0; ///< potential difference per volume flow, 1/cm
  double friction = 0;  ///< integral of friction(x) |u|^2 over the volume per squared flow
  double narrowest = 0; ///< cm^2, least mean area of the level sets of the potential
};

/// Irrotational flow in axisymmetric space from the boundary `opening` through the cells whose centroids are
/// `inside` to the facets they share with cells that are not `inside` but `open`; every other boundary is a
/// wall. Linear elements; `friction` is evaluated at centroids. Throws InputError when the boundary does not
/// exist or when no way leads through.
PassageFlow passage_flow(const SimplexMesh<2>& mesh, const std::string& opening,
                         const std::function<bool(const Point<2>&)>& inside,
                         const std::function<bool(const Point<2>&)>& open,
                         const std::function<double(const Point<2>&)>& friction);

} // namespace undula::geometry
