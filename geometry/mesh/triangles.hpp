// Triangles in space: distances in floating point.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "geometry/mesh/segments.hpp"

namespace undula::geometry {

/// The point of a triangle that is nearest to x, cm. The triangle needs an area.
inline Point<3> nearest_on_triangle(const std::array<Point<3>, 3>& corners, const Point<3>& x) {
  const Point<3> normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  bool above = true; // x stands over the inside
  double nearest = 0;
  Point<3> on_edge = corners[0];
  for (int k = 0; k < 3; ++k) {
    const auto &a = corners[k], &b = corners[(k + 1) % 3];
    if (normal.cross(b - a).dot(x - a) >= 0) continue;
    const Point<3> point = a + nearest_on_segment<3>(a, b, x) * (b - a);
    const double distance = (x - point).squaredNorm();
    if (above || distance < nearest) {
      nearest = distance;
      on_edge = point;
    }
    above = false;
  }
  if (!above) return on_edge;
  return x - normal * (normal.dot(x - corners[0]) / normal.squaredNorm());
}

} // namespace undula::geometry
