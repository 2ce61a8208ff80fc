#include "geometry/mesh/sized_segments.hpp"

#include <limits>
#include <utility>

namespace undula::geometry {
namespace {

constexpr int leaf = 4;

Point<2> middle(const SizedSegment& s) { return 0.5 * (s.segment.a + s.segment.b); }

} // namespace

SizedSegments::SizedSegments(std::vector<SizedSegment> segments, double growth, DistanceFunction distance)
    : growth_(growth), distance_(distance), segments_(std::move(segments)) {
  if (!segments_.empty()) build(0, static_cast<int>(segments_.size()));
}

int SizedSegments::build(int begin, int end) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  Node node;
  node.begin = begin;
  node.end = end;
  node.low = Point<2>::Constant(std::numeric_limits<double>::infinity());
  node.high = -node.low;
  node.least = std::numeric_limits<double>::infinity();
  for (int i = begin; i < end; ++i) {
    const auto& [segment, size, source] = segments_[i];
    node.low = node.low.cwiseMin(segment.a).cwiseMin(segment.b);
    node.high = node.high.cwiseMax(segment.a).cwiseMax(segment.b);
    node.least = std::min(node.least, size);
  }
  if (end - begin > leaf) {
    const Point<2> extent = node.high - node.low;
    const int axis = extent.x() >= extent.y() ? 0 : 1;
    const int half = begin + (end - begin) / 2;
    std::nth_element(segments_.begin() + begin, segments_.begin() + half, segments_.begin() + end,
                     [&](const auto& a, const auto& b) { return middle(a)[axis] < middle(b)[axis]; });
    build(begin, half);
    node.right = build(half, end);
  }
  nodes_[index] = node;
  return index;
}

void SizedSegments::lower(int index, const Point<2>& x, double& size, int& source) const {
  const Node& node = nodes_[index];
  // A little less than what any segment below can ask for, whatever the rounding.
  constexpr double safe = 1 - 1e-9;
  const double bound = node.least + growth_ * (x - x.cwiseMax(node.low).cwiseMin(node.high)).norm();
  if (bound * safe >= size) return;
  if (node.right >= 0) {
    lower(index + 1, x, size, source);
    lower(node.right, x, size, source);
    return;
  }
  for (int i = node.begin; i < node.end; ++i) {
    const auto& [segment, own, from] = segments_[i];
    const double asked = own + growth_ * distance_(segment, x);
    if (asked < size) {
      size = asked;
      source = from;
    }
  }
}

void SizedSegments::lower(const Point<2>& x, double& size, int& source) const {
  if (!nodes_.empty()) lower(0, x, size, source);
}

} // namespace undula::geometry
