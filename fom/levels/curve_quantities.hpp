// What a point of a curve says, by name: for studies and tables over many runs.
#pragma once

#include <array>

#include "fom/levels/curve_point.hpp"

namespace undula::fom {

struct CurveQuantity {
  const char* name; ///< ends in the unit
  double CurvePoint::*value;
};

/// The mean flow first.
inline constexpr std::array<CurveQuantity, 21> curve_quantities = {{
    {"flow_l_per_min", &CurvePoint::flow_l_per_min},
    {"hydraulic_power_mW", &CurvePoint::power_mW},
    {"holder_power_mW", &CurvePoint::holder_power_mW},
    {"actuator_power_mW", &CurvePoint::actuator_power_mW},
    {"electrical_power_mW", &CurvePoint::electrical_power_mW},
    {"efficiency_percent", &CurvePoint::efficiency_percent},
    {"stroke_mm", &CurvePoint::stroke_mm},
    {"clearance_min_mm", &CurvePoint::clearance_min_mm},
    {"speed_max_cm_per_s", &CurvePoint::speed_max_cm_per_s},
    {"haemolysis_percent", &CurvePoint::haemolysis_percent},
    {"scalar_stress_max_Pa", &CurvePoint::scalar_stress_max_Pa},
    {"stressed_volume_mm3", &CurvePoint::stressed_volume_mm3},
    {"film_unresolved_percent", &CurvePoint::film_unresolved_percent},
    {"flow_per_turn_ml", &CurvePoint::flow_per_turn_ml},
    {"ripple_l_per_min", &CurvePoint::ripple_l_per_min},
    {"leak_l_per_min", &CurvePoint::leak_l_per_min},
    {"torque_N_m", &CurvePoint::torque_N_m},
    {"torque_max_N_m", &CurvePoint::torque_max_N_m},
    {"roller_force_max_N", &CurvePoint::roller_force_max_N},
    {"outlet_pressure_min_mmHg", &CurvePoint::outlet_pressure_min_mmHg},
    {"outlet_pressure_max_mmHg", &CurvePoint::outlet_pressure_max_mmHg},
}};

} // namespace undula::fom
