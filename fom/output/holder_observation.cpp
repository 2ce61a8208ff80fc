#include "fom/output/holder_observation.hpp"

namespace undula::fom {

HolderObservation observe_holder(const ActuatorSettings* actuator, double voltage, double displacement,
                                 double velocity, double force) {
  HolderObservation seen;
  seen.displacement = displacement;
  seen.velocity = velocity;
  seen.force = force;
  if (!actuator) return seen;
  seen.voltage = voltage;
  seen.actuator_force = voltage_force(*actuator, voltage) - coil_damping(*actuator) * velocity;
  seen.actuator_power = seen.actuator_force * velocity;
  seen.electrical_power = electrical_power(*actuator, voltage, velocity);
  return seen;
}

} // namespace undula::fom
