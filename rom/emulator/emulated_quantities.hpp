// What of a curve's point an emulator repeats.
#pragma once

#include <array>

#include "rom/curve/curve_point.hpp"

namespace undula::rom {

struct EmulatedColumn {
  const char* name;
  const char* unit;
  double CurvePoint::*value;
};

/// The mean flow first. Means over a period, but for clearance and speed, which are extremes.
inline constexpr std::array<EmulatedColumn, 9> emulated_columns = {{
    {"flow_l_per_min", "l/min", &CurvePoint::flow_l_per_min},
    {"holder_power_mW", "mW", &CurvePoint::holder_power_mW},
    {"actuator_power_mW", "mW", &CurvePoint::actuator_power_mW},
    {"electrical_power_mW", "mW", &CurvePoint::electrical_power_mW},
    {"stroke_mm", "mm", &CurvePoint::stroke_mm},
    {"clearance_min_mm", "mm", &CurvePoint::clearance_min_mm},
    {"speed_max_cm_per_s", "cm/s", &CurvePoint::speed_max_cm_per_s},
    {"scalar_stress_max_Pa", "Pa", &CurvePoint::scalar_stress_max_Pa},
    {"stressed_volume_mm3", "mm^3", &CurvePoint::stressed_volume_mm3},
}};

} // namespace undula::rom
