#include "fom/scene/shape_outline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/mesh/outline_faults.hpp"
#include "geometry/mesh/segments.hpp"

namespace undula::fom {
namespace {

/// The half of a circle with r >= 0, about a centre on the axis.
std::vector<Point<2>> half_circle(const Position& centre, double radius, double size, int most) {
  auto points = circle(centre, radius, size, most);
  std::erase_if(points, [&](const Point<2>& x) { return x[0] < 1e-6 * radius; });
  // From the lower pole to the upper one.
  std::sort(points.begin(), points.end(), [](const Point<2>& a, const Point<2>& b) { return a[1] < b[1]; });
  points.insert(points.begin(), Point<2>(0.0, centre[1] - radius));
  points.emplace_back(0.0, centre[1] + radius);
  return points;
}

} // namespace

std::vector<Point<2>> circle(const Position& centre, double radius, double size, int most) {
  const double quarter = std::min(0.5 * std::numbers::pi * radius / size, 1e6);
  const int corners = 4 * std::clamp(static_cast<int>(std::ceil(quarter)), 4, most / 4);
  std::vector<Point<2>> points;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / corners;
    points.push_back(point_of(centre) + radius * Point<2>(std::cos(angle), std::sin(angle)));
  }
  return points;
}

std::vector<Point<2>> corners_of(const ShapeStatement& shape, double size, bool axisymmetric, int most) {
  if (shape.radius > 0 && axisymmetric && shape.centre[0] == 0)
    return half_circle(shape.centre, shape.radius, size, most);
  if (shape.radius > 0) return circle(shape.centre, shape.radius, size, most);
  std::vector<Point<2>> points;
  for (const auto& corner : shape.outline) points.push_back(point_of(corner));
  return points;
}

std::vector<Point<2>> body_corners(const BodyStatement& body, bool axisymmetric) {
  auto corners = corners_of(body.shape, body.size, axisymmetric);
  const double small = 1e-9 * largest_extent(corners);
  for (const auto& position : body.line) {
    const Point<2> x = point_of(position);
    const bool on_circle = body.shape.radius > 0 && std::abs((x - point_of(body.shape.centre)).norm() -
                                                             body.shape.radius) <= 1e-6 * body.shape.radius;
    const std::size_t n = corners.size();
    std::size_t edge = n;
    double nearest = on_circle ? HUGE_VAL : small;
    bool known = false;
    for (std::size_t i = 0; i < n && !known; ++i) {
      const Segment<2> side = {corners[i], corners[(i + 1) % n]};
      known = segments_meet(side, {x, x}); // the mesher splits the edge there
      if (const double d = distance(side, x); d <= nearest) {
        nearest = d;
        edge = i;
      }
    }
    if (known || edge == n) continue;
    // In place of a corner of the circle that is near, or between two.
    const std::size_t next = (edge + 1) % n;
    const double length = (corners[next] - corners[edge]).norm();
    const auto gives_way = [&](std::size_t i) {
      return on_circle && (corners[i] - x).norm() < 0.3 * length && !(axisymmetric && corners[i][0] == 0);
    };
    if (gives_way(edge))
      corners[edge] = x;
    else if (gives_way(next))
      corners[next] = x;
    else
      corners.insert(corners.begin() + static_cast<std::ptrdiff_t>(edge) + 1, x);
  }
  return corners;
}

} // namespace undula::fom
