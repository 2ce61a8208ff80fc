// A pump of right angles, whose gaps are known exactly.
#pragma once

#include "geometry/wave_pump/profile.hpp"

namespace undula::geometry {

/// Gaps: 0.4 above and below the membrane, 0.1 at its rim, 0.3 between magnet and stator, 0.5 between housing
/// and stator at the top (all cm).
inline PumpProfile simple_pump() {
  PumpProfile profile;
  profile.housing = {
      "housing.profile", {{0.5, 3.0}, {0.5, 2.0}, {3.0, 2.0}, {3.0, -0.5}, {0.5, -0.5}, {0.5, -2.0}}, {}};
  profile.stator = {"stator.profile", {{0.0, 1.5}, {2.0, 1.5}, {2.0, 0.5}, {0.0, 0.5}}, {}};
  profile.membrane.inner_radius = 0.6;
  profile.membrane.outer_radius = 2.9;
  profile.membrane.clamp_radius = 2.0;
  profile.membrane.thickness = {"membrane.thickness", {{0.6, 0.2}, {2.9, 0.2}}, {}};
  profile.magnet = {"magnet.polygon", {{2.3, 0.9}, {2.3, 1.2}, {2.6, 1.2}, {2.6, 0.9}}, {}};
  return profile;
}

} // namespace undula::geometry
