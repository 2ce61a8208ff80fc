#include "fom/actuator/actuator.hpp"

#include <algorithm>
#include <cmath>

#include "rom/base/units.hpp"

namespace undula::fom {
namespace {

constexpr double cm_per_m = 100;
constexpr double erg_per_J = units::dyn_per_N * cm_per_m;

/// How far the holder is in a stop, with the sign of its displacement, cm.
double in_stop(const ActuatorSettings& actuator, double displacement) {
  if (actuator.stop <= 0) return 0;
  return std::copysign(std::max(std::abs(displacement) - actuator.stop, 0.0), displacement);
}

} // namespace

HolderResistance holder_resistance(const ActuatorSettings& actuator, double displacement, double velocity) {
  const double inside = in_stop(actuator, displacement);
  HolderResistance resistance;
  resistance.by_velocity = actuator.damping + coil_damping(actuator);
  resistance.by_displacement = actuator.stiffness + (inside != 0 ? actuator.stop_stiffness : 0.0);
  resistance.force = actuator.stiffness * displacement + actuator.stop_stiffness * inside +
                     resistance.by_velocity * velocity;
  return resistance;
}

double coil_damping(const ActuatorSettings& actuator) {
  const double newton_per_volt = actuator.force_per_volt / units::dyn_per_N;
  return newton_per_volt * newton_per_volt * actuator.coil_resistance * units::dyn_per_N / cm_per_m;
}

double electrical_power(const ActuatorSettings& actuator, double voltage, double velocity) {
  if (actuator.coil_resistance <= 0) return 0;
  const double back_emf = // V
      actuator.force_per_volt / units::dyn_per_N * actuator.coil_resistance * velocity / cm_per_m;
  return voltage * (voltage - back_emf) / actuator.coil_resistance * erg_per_J;
}

} // namespace undula::fom
