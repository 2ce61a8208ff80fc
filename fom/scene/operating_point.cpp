#include "fom/scene/operating_point.hpp"

#include <cmath>
#include <numbers>

#include "rom/base/smooth_ramp.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::fom {

namespace {

/// sin(2 pi f t) with the smooth start of the scene.
double swing(const Scene& scene, double t) {
  const double frequency = scene.operating_point.frequency;
  return smooth_ramp(t, scene.time.ramp_periods / frequency) * std::sin(2 * std::numbers::pi * frequency * t);
}

} // namespace

double holder_displacement(const Scene& scene, double t) {
  const auto& point = scene.operating_point;
  return point.stroke_scale * point.stroke * swing(scene, t);
}

std::string setting_text(const OperatingPoint& point) {
  const std::string frequency = plain_number(point.frequency) + " Hz";
  if (point.drive == Drive::rollers) return frequency;
  return frequency + ", " +
         (point.drive == Drive::voltage
              ? plain_number(point.voltage) + " V"
              : "stroke " + plain_number(units::length_to_mm(point.stroke)) + " mm");
}

double drive_voltage(const Scene& scene, double t) { return scene.operating_point.voltage * swing(scene, t); }

double outlet_pressure(const Scene& scene, double t) {
  const auto& point = scene.operating_point;
  return point.head * smooth_ramp(t, scene.time.ramp_periods / point.frequency);
}

} // namespace undula::fom
