// Straight segments: distances in floating point, exact tests, pairs of them that are near each other.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::geometry {

/// From a to b, cm.
template <int dim>
struct Segment {
  Point<dim> a, b;
};

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

/// Point of the segment nearest to x; its only one where it has no length.
Point<2> nearest_point(const Segment<2>& segment, const Point<2>& x);

/// Distance of x to nearest_point, cm. Rounds otherwise than distance_to_segment.
double distance(const Segment<2>& segment, const Point<2>& x);

/// Whether the two share a point; exact for the given coordinates.
bool segments_meet(const Segment<2>& first, const Segment<2>& second);

/// Calls visit(i, j), i < j, for the pairs of segments whose boxes are no further apart than `margin` (cm),
/// until it returns false. Sorts by the first coordinate and prunes by it.
template <typename Visit>
void visit_near_pairs(const std::vector<Segment<2>>& segments, double margin, const Visit& visit) {
  std::vector<std::size_t> order(segments.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto low = [&](std::size_t i, int c) { return std::min(segments[i].a[c], segments[i].b[c]); };
  const auto high = [&](std::size_t i, int c) { return std::max(segments[i].a[c], segments[i].b[c]); };
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return low(i, 0) < low(j, 0); });
  for (std::size_t k = 0; k < order.size(); ++k)
    for (std::size_t m = k + 1; m < order.size(); ++m) {
      const std::size_t i = order[k], j = order[m];
      if (low(j, 0) > high(i, 0) + margin) break;
      if (low(j, 1) > high(i, 1) + margin || low(i, 1) > high(j, 1) + margin) continue;
      if (!visit(std::min(i, j), std::max(i, j))) return;
    }
}

} // namespace undula::geometry
