// Gaps of a pump: where they are, how wide, and the element size they ask for.
#pragma once

#include <functional>
#include <vector>

#include "geometry/wave_pump/profile.hpp"

namespace undula::geometry {

/// A straight bridge over a gap, from a point of one side to the nearest point of the other side.
struct GapBridge {
  Point<2> from, to; ///< cm
  double width() const { return (to - from).norm(); }
};

/// Bridges over the gaps between housing, stator, membrane and magnet, started from either side, where
/// narrower than `widest` (cm). Neighbours are no further apart than `spacing` times their width.
std::vector<GapBridge> gap_bridges(const PumpProfile& profile, double widest, double spacing);

/// Clearance (cm) on the way through x: distance to the nearest solid (negative inside of it) plus distance
/// to the nearest wall. Between two parallel sides, and in the solid behind, it is the width of the gap.
double local_clearance(const PumpProfile& profile, const Point<2>& x);

/// Sizes of the meshes of a pump.
struct PumpMeshSizes {
  double gap_elements = 0;  ///< elements across a gap between solid and wall or between the walls, >= 2
  double channel_size = 0;  ///< cm, upper bound of the background's size
  double membrane_size = 0; ///< cm, upper bound of the solids' size
  double growth = 0;        ///< increase of the background's size per unit distance from a gap, >= 0
};

/// Target size (cm) of the background at a point: width / gap_elements along every bridge over a gap, growing
/// away from them at the rate `growth` up to channel_size. The function keeps no reference to its arguments.
/// Throws InputError when a size makes no sense.
std::function<double(const Point<2>&)> pump_size_field(const PumpProfile& profile,
                                                       const PumpMeshSizes& sizes);

} // namespace undula::geometry
