// What keeps a closed outline from being meshed.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::geometry {

/// Corners and edges are counted from 0; edge i goes from corner i to the next.
struct OutlineFault {
  enum class Kind {
    repeated_corner, ///< the corners `first` and `second` are the same point
    crossing_edges,  ///< the edges `first` and `second` cross, touch or fold back on each other
    narrow_place ///< the edges `first` and `second` come nearer to each other than `smallest`, or the edge
                 ///< `first` = `second` is shorter
  };
  Kind kind{};
  std::size_t first = 0, second = 0;
  double distance = 0; ///< cm, of a narrow place
};

/// Places narrower than this part of the largest extent cannot be meshed in double precision.
inline constexpr double narrowest_part = 1e-6;

/// The first fault of a closed polygon in the order of the kinds; none: it is simple and nowhere narrower
/// than `smallest` (cm). Repetition and crossing are decided exactly.
std::optional<OutlineFault> outline_fault(const std::vector<Point<2>>& corners, double smallest);

/// Larger side of the box around the points, cm.
double largest_extent(const std::vector<Point<2>>& points);

/// Even-odd rule: whether x is inside of the closed polygon.
bool surrounds(const std::vector<Point<2>>& corners, const Point<2>& x);

/// Distance of x from the closed polygon's line, cm.
double distance_to_outline(const std::vector<Point<2>>& corners, const Point<2>& x);

} // namespace undula::geometry
