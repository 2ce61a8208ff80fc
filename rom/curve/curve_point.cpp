#include "rom/curve/curve_point.hpp"

#include <cmath>

namespace undula::rom {

double efficiency_percent(const CurvePoint& point) {
  for (const double power : {point.electrical_power_mW, point.actuator_power_mW, point.holder_power_mW})
    if (std::isfinite(power) && power > 0) return 100 * point.power_mW / power;
  return CurvePoint::unknown;
}

} // namespace undula::rom
