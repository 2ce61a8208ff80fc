// Regions of the plane laid over one another: what they share, which parts hang together, what bounds them.
// In floating point, for checks; cuts that are computed with are in geometry/cut.
#pragma once

#include <map>
#include <vector>

#include "geometry/mesh/segments.hpp"

namespace undula::geometry {

/// Points that an odd number of the closed lines made of these segments surround.
using PlaneRegion = std::vector<Segment<2>>;

/// A part of the plane that hangs together and lies inside of the same regions everywhere.
struct OverlayPart {
  std::vector<char> inside;                      ///< by region
  double area = 0;                               ///< cm^2
  std::map<std::pair<int, int>, double> borders; ///< (region, segment) -> length (cm) that bounds the part

  /// Inside of region `one` and of no other.
  [[nodiscard]] bool only_in(int one) const;
};

/// A quadrilateral with two horizontal sides; some have no length. Counter-clockwise from its lower left
/// corner.
struct OverlayPiece {
  std::array<Point<2>, 4> corners; ///< cm
  int part = 0;                    ///< index into PlaneOverlay::parts
};

/// Parts outside of all regions are left out.
struct PlaneOverlay {
  std::vector<OverlayPart> parts;
  std::vector<OverlayPiece> pieces; ///< the parts, cut at the heights of all corners and crossings
};

/// Lays the regions over one another. What is narrower than 1e-10 of the largest extent counts as nothing.
PlaneOverlay lay_over(const std::vector<PlaneRegion>& regions);

} // namespace undula::geometry
