// Boxes of tetrahedra on a grid.
#pragma once

#include <array>

#include "geometry/mesh/box_grid.hpp"

namespace undula::geometry {

/// `counts` bricks along each axis, each of six tetrahedra around its diagonal from the low to the high
/// corner (Kuhn 1960), so that neighbours match. Boundary names: x_low, x_high, y_low, y_high, z_low, z_high.
/// Throws InputError if a side of the box has no length or a count is not positive.
SimplexMesh<3> box_mesh(const Box<3>& box, const std::array<int, 3>& counts);

} // namespace undula::geometry
