// What the operating point of a scene imposes in time: the motion of the holder and the head between two
// openings.
#pragma once

#include <string>

#include "fom/scene/scene.hpp"

namespace undula::fom {

/// Imposed displacement of the holder, Phi ramp(t) sin(2 pi f t), cm.
double holder_displacement(const Scene& scene, double t);

/// "120 Hz, stroke 0.53 mm" or "120 Hz, 40 V": what stays along a curve.
std::string setting_text(const OperatingPoint& point);

/// Voltage at the actuator at time t, V: voltage * sin(2 pi f t), with the smooth start of the stroke.
double drive_voltage(const Scene& scene, double t);

/// Pressure at the outlet, head times ramp(t), dyn/cm^2; the inlet is at zero.
double outlet_pressure(const Scene& scene, double t);

/// Names of the two openings, as keys of Operators::openings.
inline constexpr const char* inlet_name = "inlet";
inline constexpr const char* outlet_name = "outlet";

} // namespace undula::fom
