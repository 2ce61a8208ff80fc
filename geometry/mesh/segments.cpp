#include "geometry/mesh/segments.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace undula::geometry {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Segment_2 exact(const PlaneSegment& segment) {
  return {Kernel::Point_2(segment.a.x(), segment.a.y()), Kernel::Point_2(segment.b.x(), segment.b.y())};
}

} // namespace

double distance(const PlaneSegment& segment, const Point<2>& x) {
  const Point<2> along = segment.b - segment.a;
  const double squared_length = along.squaredNorm();
  if (squared_length == 0) return (x - segment.a).norm();
  const double s = std::clamp((x - segment.a).dot(along) / squared_length, 0.0, 1.0);
  return (segment.a + s * along - x).norm();
}

bool segments_meet(const PlaneSegment& first, const PlaneSegment& second) {
  return CGAL::do_intersect(exact(first), exact(second));
}

std::vector<PlaneSegment> closed_polygon(const std::vector<Point<2>>& corners) {
  std::vector<PlaneSegment> segments;
  for (std::size_t i = 0; i < corners.size(); ++i)
    segments.push_back({corners[i], corners[(i + 1) % corners.size()]});
  return segments;
}

} // namespace undula::geometry
