// What two tetrahedra share, in floating point.
#pragma once

#include <array>

#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::geometry {

/// Volume (cm^3) that two positively oriented tetrahedra share: the one is cut by the planes of the other,
/// into tetrahedra.
double overlap_volume(const std::array<Point<3>, 4>& a, const std::array<Point<3>, 4>& b);

} // namespace undula::geometry
