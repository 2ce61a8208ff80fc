#include "geometry/mesh/outline_faults.hpp"

#include <limits>
#include <map>

#include "geometry/mesh/box_grid.hpp"
#include "geometry/mesh/polygons.hpp"
#include "geometry/mesh/segments.hpp"

namespace undula::geometry {
namespace {

using Kind = OutlineFault::Kind;

std::optional<OutlineFault> repeated_corner(const std::vector<Point<2>>& corners) {
  std::map<std::pair<double, double>, std::size_t> known;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto [entry, added] = known.try_emplace({corners[i].x(), corners[i].y()}, i);
    if (!added) return OutlineFault{Kind::repeated_corner, entry->second, i, 0};
  }
  return std::nullopt;
}

/// Whether two edges share more than the corner of neighbours.
bool clash(const std::vector<Segment<2>>& edges, std::size_t i, std::size_t j) {
  const std::size_t n = edges.size();
  const auto on = [](const Segment<2>& edge, const Point<2>& x) { return segments_meet(edge, {x, x}); };
  if (j == i + 1) return on(edges[i], edges[j].b) || on(edges[j], edges[i].a);
  if (i == 0 && j == n - 1) return on(edges[i], edges[j].a) || on(edges[j], edges[i].b);
  return segments_meet(edges[i], edges[j]);
}

double gap(const Segment<2>& a, const Segment<2>& b) {
  return std::min({distance(a, b.a), distance(a, b.b), distance(b, a.a), distance(b, a.b)});
}

} // namespace

std::optional<OutlineFault> outline_fault(const std::vector<Point<2>>& corners, double smallest) {
  if (auto fault = repeated_corner(corners)) return fault;
  const auto edges = polygon_sides(corners);
  const std::size_t n = edges.size();
  std::optional<OutlineFault> crossing, short_edge, narrow;
  const auto keep_first = [](std::optional<OutlineFault>& kept, const OutlineFault& found) {
    if (!kept || std::pair(found.first, found.second) < std::pair(kept->first, kept->second)) kept = found;
  };
  for (std::size_t i = 0; i < n; ++i)
    if (const double length = (edges[i].b - edges[i].a).norm(); length < smallest)
      keep_first(short_edge, {Kind::narrow_place, i, i, length});
  visit_near_pairs(edges, smallest, [&](std::size_t i, std::size_t j) {
    if (clash(edges, i, j)) {
      keep_first(crossing, {Kind::crossing_edges, i, j, 0});
      return true;
    }
    if (j == i + 1 || (i == 0 && j == n - 1)) return true;
    if (const double between = gap(edges[i], edges[j]); between < smallest)
      keep_first(narrow, {Kind::narrow_place, i, j, between});
    return true;
  });
  return crossing ? crossing : short_edge ? short_edge : narrow;
}

double largest_extent(const std::vector<Point<2>>& points) {
  if (points.empty()) return 0;
  const auto box = box_around<2>(points);
  return (box.high - box.low).maxCoeff();
}

bool surrounds(const std::vector<Point<2>>& corners, const Point<2>& x) {
  bool odd = false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto &a = corners[i], &b = corners[(i + 1) % corners.size()];
    if ((a.y() > x.y()) != (b.y() > x.y()) &&
        x.x() < a.x() + (x.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
      odd = !odd;
  }
  return odd;
}

double distance_to_outline(const std::vector<Point<2>>& corners, const Point<2>& x) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& edge : polygon_sides(corners)) least = std::min(least, distance(edge, x));
  return least;
}

} // namespace undula::geometry
