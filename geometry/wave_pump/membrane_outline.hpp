// The section of the membrane at rest.
#pragma once

#include <array>
#include <vector>

#include "geometry/wave_pump/profile.hpp"

namespace undula::geometry {

/// A closed polygon, counter-clockwise from the lower end of the tip: lower side, rim, upper side, tip.
/// Corners of tip and rim are arcs where the profile states a radius: chords of at most 22.5 degrees, that
/// belong to tip and rim.
struct MembraneOutline {
  enum Side { lower = 0, rim = 1, upper = 2, tip = 3 };
  std::vector<Point<2>> points;  ///< (r, z), cm
  std::vector<Side> sides;       ///< of the edge from point i to point i + 1
  std::array<int, 2> clamp = {}; ///< the points on the lower and the upper side at the clamp radius
};
MembraneOutline membrane_outline(const MembraneProfile& membrane);

/// Largest radius that the corners of an end can have, cm: nine tenths of what half of its thickness leaves
/// room for, or the side up to the next point of the thickness or the clamp radius.
double largest_tip_radius(const MembraneProfile& membrane);
double largest_rim_radius(const MembraneProfile& membrane);

/// Least radius of a corner that is not sharp: its chords would be far below any element.
inline double smallest_corner_radius(double largest) { return 0.05 * largest; }

/// Whether a corner that is not sharp may have this radius.
inline bool corner_fits(double radius, double largest) {
  return radius >= smallest_corner_radius(largest) && radius <= largest;
}

} // namespace undula::geometry
