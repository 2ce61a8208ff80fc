#include "geometry/mesh/segments.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace undula::geometry {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Segment_2 exact(const Segment<2>& segment) {
  return {Kernel::Point_2(segment.a.x(), segment.a.y()), Kernel::Point_2(segment.b.x(), segment.b.y())};
}

} // namespace

Point<2> nearest_point(const Segment<2>& segment, const Point<2>& x) {
  const auto& [a, b] = segment;
  return (b - a).squaredNorm() == 0 ? a : Point<2>(a + nearest_on_segment<2>(a, b, x) * (b - a));
}

double distance(const Segment<2>& segment, const Point<2>& x) {
  return (nearest_point(segment, x) - x).norm();
}

bool segments_meet(const Segment<2>& first, const Segment<2>& second) {
  return CGAL::do_intersect(exact(first), exact(second));
}

} // namespace undula::geometry
