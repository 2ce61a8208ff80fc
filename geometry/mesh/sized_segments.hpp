// Segments that ask for an element size: the least that any of them asks for at a point.
#pragma once

#include <vector>

#include "geometry/mesh/segments.hpp"

namespace undula::geometry {

struct SizedSegment {
  Segment<2> segment;
  double size = 0; ///< cm, on the segment
  int source = 0;  ///< what it came from, for messages
};

using DistanceFunction = double (*)(const Segment<2>&, const Point<2>&);

inline double distance_to(const Segment<2>& segment, const Point<2>& x) { return distance(segment, x); }

/// size + growth * distance, least over all segments. Found by a tree of boxes, equal bit for bit to trying
/// all of them.
class SizedSegments {
public:
  /// `distance` may differ from geometry::distance by rounding.
  SizedSegments(std::vector<SizedSegment> segments, double growth, DistanceFunction distance = distance_to);

  /// Lowers `size` to what the segments ask for at x, and sets `source` if they do.
  void lower(const Point<2>& x, double& size, int& source) const;

private:
  struct Node {
    Point<2> low, high;
    double least = 0;       ///< size
    int begin = 0, end = 0; ///< segments
    int right = -1;         ///< second child; the first follows; -1: a leaf
  };
  int build(int begin, int end);
  void lower(int node, const Point<2>& x, double& size, int& source) const;

  double growth_;
  DistanceFunction distance_;
  std::vector<SizedSegment> segments_;
  std::vector<Node> nodes_; ///< the root first
};

} // namespace undula::geometry
