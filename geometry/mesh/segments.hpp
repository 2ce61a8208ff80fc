// Straight segments in the plane: distances, exact tests, pairs of them that are near each other.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::geometry {

struct PlaneSegment {
  Point<2> a, b; ///< cm
};

/// Distance of x from the segment, cm; from its point where it has no length.
double distance(const PlaneSegment& segment, const Point<2>& x);

/// Whether the two share a point; exact for the given coordinates.
bool segments_meet(const PlaneSegment& first, const PlaneSegment& second);

/// The segments of a closed polygon, from each corner to the next.
std::vector<PlaneSegment> closed_polygon(const std::vector<Point<2>>& corners);

/// Calls visit(i, j), i < j, for the pairs of segments whose boxes are no further apart than `margin` (cm),
/// until it returns false. Sorts by the first coordinate and prunes by it.
template <typename Visit>
void visit_near_pairs(const std::vector<PlaneSegment>& segments, double margin, const Visit& visit) {
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
