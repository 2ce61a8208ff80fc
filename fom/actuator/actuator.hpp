// A linear motor that drives the holder: a force in proportion to the voltage, on a mass with a suspension.
#pragma once

namespace undula::fom {

/// What the holder is driven with.
enum class Drive {
  stroke,  ///< its motion is imposed
  voltage, ///< the actuator's force; the motion is an answer
  rollers  ///< no holder: rollers on a rotor that turns at the frequency of the operating point
};

/// The equation of the holder (displacement w, cm) is
///   moving_mass (w'' - gravity) + (damping + coil's damping) w' + stiffness w + stop(w)
///     = force_per_volt V(t) + reaction,
/// `reaction` being what membrane and fluid do to it. It follows from the coil's V = R i + L di/dt + B w' and
/// its force B i, where the inductance L is left out: i = (V - B w') / R, so that force_per_volt = B / R, and
/// the back-EMF is a damping of B^2 / R = force_per_volt^2 R.
struct ActuatorSettings {
  double force_per_volt = 0;  ///< dyn/V
  double moving_mass = 0;     ///< g, of what moves with the holder, the membrane left out
  double stiffness = 0;       ///< dyn/cm, of the suspension
  double damping = 0;         ///< dyn s/cm, the coil's left out where its resistance is stated
  double coil_resistance = 0; ///< ohm; 0: not stated
  double gravity = 0;         ///< cm/s^2, along the axis, on the moving mass
  double stop = 0;            ///< cm, displacement at which the holder meets an end stop; 0: none
  double stop_stiffness = 0;  ///< dyn/cm, of the stops
};

/// Force that resists the holder, and its derivatives.
struct HolderResistance {
  double force = 0;           ///< dyn
  double by_displacement = 0; ///< dyn/cm
  double by_velocity = 0;     ///< dyn s/cm
};

/// Of suspension, damping and stops, the inertia left out.
HolderResistance holder_resistance(const ActuatorSettings& actuator, double displacement, double velocity);

/// Damping by the back-EMF, dyn s/cm; 0 where the coil's resistance is not stated.
double coil_damping(const ActuatorSettings& actuator);

/// Force on a holder at rest, dyn, at a voltage.
inline double voltage_force(const ActuatorSettings& actuator, double voltage) {
  return actuator.force_per_volt * voltage;
}

/// What drives the holder: force of the voltage, and weight, dyn.
inline double driving_force(const ActuatorSettings& actuator, double voltage) {
  return voltage_force(actuator, voltage) + actuator.moving_mass * actuator.gravity;
}

/// Power that the coil takes, erg/s, at a voltage and the holder's velocity (cm/s); 0 where its resistance is
/// not stated.
double electrical_power(const ActuatorSettings& actuator, double voltage, double velocity);

} // namespace undula::fom
