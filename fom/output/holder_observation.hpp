// The holder and what drives it, at every step.
#pragma once

#include "fom/actuator/actuator.hpp"

namespace undula::fom {

/// In cgs.
struct HolderObservation {
  double displacement = 0;   ///< cm, axial, of the outermost probe
  double velocity = 0;       ///< cm/s
  double force = 0;          ///< dyn, on membrane and fluid
  double voltage = 0;        ///< V; this and what follows: 0 where the motion is imposed
  double actuator_force = 0; ///< dyn, of the coil: its back-EMF is subtracted where its resistance is stated
  double actuator_power = 0; ///< erg/s, actuator_force times velocity
  double electrical_power = 0; ///< erg/s, taken by the coil; 0 where its resistance is not stated
};

/// Of a holder at this place, that puts `force` on membrane and fluid, driven by `actuator` (null: its motion
/// is imposed).
HolderObservation observe_holder(const ActuatorSettings* actuator, double voltage, double displacement,
                                 double velocity, double force);

} // namespace undula::fom
