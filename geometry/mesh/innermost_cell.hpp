// Where a point is in a mesh.
#pragma once

#include <limits>

#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::geometry {

/// The cell that `x` is deepest in, or least outside of: the one with the largest smallest barycentric
/// coordinate. Looks at all cells; the mesh needs one.
template <int dim>
int innermost_cell(const SimplexMesh<dim>& mesh, const Point<dim>& x) {
  int innermost = 0;
  double depth = -std::numeric_limits<double>::infinity();
  for (int cell = 0; cell < static_cast<int>(mesh.cells.size()); ++cell) {
    const double smallest = barycentric_coordinates(mesh, cell, x).minCoeff();
    if (smallest > depth) {
      depth = smallest;
      innermost = cell;
    }
  }
  return innermost;
}

} // namespace undula::geometry
