// What the actuator adds to the equation of the holder at the end of a time step: shared by all levels.
#pragma once

#include "fom/actuator/actuator.hpp"

namespace undula::fom {

/// Motion of the holder at the end of a step.
struct HolderMotion {
  double displacement = 0; ///< cm
  double velocity = 0;     ///< cm/s
  double acceleration = 0; ///< cm/s^2, by the scheme
  double rate = 0;         ///< 1/s: acceleration per velocity; velocity per displacement is the same
};

/// Force that actuator, suspension and mass need beside the one on membrane and fluid: 0 is their sum.
struct HolderTerms {
  double force = 0;       ///< dyn
  double by_velocity = 0; ///< its derivative, dyn s/cm
};

inline HolderTerms holder_terms(const ActuatorSettings& actuator, double voltage,
                                const HolderMotion& motion) {
  const HolderResistance resistance = holder_resistance(actuator, motion.displacement, motion.velocity);
  return {
      actuator.moving_mass * motion.acceleration + resistance.force - driving_force(actuator, voltage),
      actuator.moving_mass * motion.rate + resistance.by_velocity + resistance.by_displacement / motion.rate};
}

} // namespace undula::fom
