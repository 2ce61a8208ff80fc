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

/// Part of the largest radius below which a corner counts as sharp: its chords would be far below any
/// element.
constexpr double smallest_corner = 0.05;

/// Largest radius that the corners of an end can have, cm: nine tenths of what half of its thickness leaves
/// room for, or the side up to the next point of the thickness or the clamp radius.
double largest_tip_radius(const MembraneProfile& membrane);
double largest_rim_radius(const MembraneProfile& membrane);

} // namespace undula::geometry
