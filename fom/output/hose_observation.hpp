// The rollers of a peristaltic pump, and what the hose does to them, at every step.
#pragma once

#include <limits>

namespace undula::fom {

/// In cgs.
struct HoseObservation {
  double angle = 0;           ///< rad, of the first roller from the begin of the track
  double torque = 0;          ///< dyn cm, of the rotor
  double leak = 0;            ///< cm^3/s, backwards through the narrowest place of the hose
  double outlet_pressure = 0; ///< dyn/cm^2, behind the last place that a roller squeezes
  /// dyn, largest of all rollers, from hose and fluid; NaN where the hose's modulus is not stated.
  double roller_force = std::numeric_limits<double>::quiet_NaN();
};

} // namespace undula::fom
