#include "fom/scene/operating_point.hpp"

#include <cmath>
#include <numbers>

#include "rom/base/smooth_ramp.hpp"

namespace undula::fom {

double holder_displacement(const Scene& scene, double t) {
  const auto& point = scene.operating_point;
  return point.stroke_scale * point.stroke * smooth_ramp(t, scene.time.ramp_periods / point.frequency) *
         std::sin(2 * std::numbers::pi * point.frequency * t);
}

double outlet_pressure(const Scene& scene, double t) {
  const auto& point = scene.operating_point;
  return point.head * smooth_ramp(t, scene.time.ramp_periods / point.frequency);
}

} // namespace undula::fom
