// Corners of the shapes that a scene states, as the mesher gets them.
#pragma once

#include <vector>

#include "fom/fom.hpp"
#include "fom/scene/problem_statement.hpp"
#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::fom {

inline Point<2> point_of(const Position& position) { return {position[0], position[1]}; }

/// Corners of a circle, four of them on the axes through its centre, no further apart than `size` (cm); at
/// most `most`, rounded down to a multiple of four.
std::vector<Point<2>> circle(const Position& centre, double radius, double size, int most = 400000);

/// A polygon's own corners, or those of a circle no further apart than `size`. `axisymmetric`: circles about
/// a point of the axis are half discs, the meridian of a sphere.
std::vector<Point<2>> corners_of(const ShapeStatement& shape, double size, bool axisymmetric = false,
                                 int most = 400000);

/// Corners of the body's outline. Corners of its line that lie on its circle, or on an edge but for rounding,
/// are among them: an outline that ran beside them would leave flat cells.
std::vector<Point<2>> body_corners(const BodyStatement& body, bool axisymmetric);

} // namespace undula::fom
