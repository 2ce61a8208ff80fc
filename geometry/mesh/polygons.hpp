// Small polygons in floating point: area, inside or outside, triangulation, overlap.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "geometry/mesh/segments.hpp"

namespace undula::geometry {

/// The sides of a closed polygon, from each corner to the next.
std::vector<Segment<2>> polygon_sides(const std::vector<Point<2>>& polygon);

/// Whether x lies inside of closed outlines, by the even-odd rule. Their sides may come in any order and
/// direction.
bool inside_outline(std::span<const Segment<2>> sides, const Point<2>& x);

/// Signed area (cm^2) of a closed polygon, positive if counter-clockwise.
double polygon_area(const std::vector<Point<2>>& polygon);

/// Fills a simple, counter-clockwise polygon by triangles; appended to `triangles`, none inverted by more
/// than rounding, those without area left out. False, with nothing appended, if the corners do not allow it
/// in floating point.
bool triangulate_polygon(const std::vector<Point<2>>& polygon,
                         std::vector<std::array<Point<2>, 3>>& triangles);

/// Area (cm^2) that two counter-clockwise triangles share.
double overlap_area(const std::array<Point<2>, 3>& a, const std::array<Point<2>, 3>& b);

} // namespace undula::geometry
