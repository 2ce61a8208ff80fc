// Segments and small polygons in floating point: distance, area, inside or outside, triangulation, overlap.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::geometry {

/// From its first to its second end, cm.
template <int dim>
using Segment = std::array<Point<dim>, 2>;

/// Where on the segment from a to b the point nearest to x lies: 0 at a, 1 at b. The segment needs a length.
template <int dim>
double nearest_on_segment(const Point<dim>& a, const Point<dim>& b, const Point<dim>& x) {
  const Point<dim> along = b - a;
  return std::clamp((x - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
}

/// Distance (cm) of x to the segment from a to b, which needs a length.
template <int dim>
double distance_to_segment(const Point<dim>& a, const Point<dim>& b, const Point<dim>& x) {
  return (x - a - nearest_on_segment<dim>(a, b, x) * (b - a)).norm();
}

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
