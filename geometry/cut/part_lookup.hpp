// Where a point lies in a cut: in which fluid part of a background cell.
#pragma once

#include "geometry/cut/cut_mesh.hpp"

namespace undula::geometry {

/// Whether x lies in the closed simplex, up to the rounding of its barycentric coordinates.
template <int dim>
bool simplex_contains(const std::array<Point<dim>, dim + 1>& vertices, const Point<dim>& x);

/// Whether x, a point (cm) of the cell of `part`, lies in the part.
template <int dim>
bool part_contains(const CutMesh<dim>& cut, int part, const Point<dim>& x);

/// The fluid part of `cell` that contains its point x (cm); -1 if x lies in a solid.
template <int dim>
int part_at(const CutMesh<dim>& cut, int cell, const Point<dim>& x);

} // namespace undula::geometry
