#include "rom/curve/curve_columns.hpp"

namespace undula::rom {

std::span<const CurveColumn> curve_columns() {
  static constexpr CurveColumn columns[] = {
      {"head_mmHg", &CurvePoint::head_mmHg, "Head, mmHg: pressure at the outlet minus that at the inlet."},
      {"flow_l_per_min", &CurvePoint::flow_l_per_min,
       "Mean flow out of the outlet, l/min; nan where the numerics failed."},
      {"error_l_per_min", &CurvePoint::error_l_per_min,
       "Stated error of the flow against the level that the model was made from, l/min; inf: unknown."},
      {"inflow_l_per_min", &CurvePoint::inflow_l_per_min, "Mean flow into the inlet, l/min."},
      {"spread_l_per_min", &CurvePoint::spread_l_per_min,
       "Largest minus smallest mean of the last periods, l/min; 0: periodic."},
      {"hydraulic_power_mW", &CurvePoint::power_mW, "Head times flow, mW."},
      {"holder_power_mW", &CurvePoint::holder_power_mW,
       "Mean power of the holder on membrane and fluid, mW."},
      {"actuator_power_mW", &CurvePoint::actuator_power_mW, "Mean mechanical power of the actuator, mW."},
      {"electrical_power_mW", &CurvePoint::electrical_power_mW,
       "Mean electrical power, with that of the coil's resistance, mW."},
      {"efficiency_percent", &CurvePoint::efficiency_percent,
       "Hydraulic power of the electrical, else the actuator's, else the holder's power, %."},
      {"holder_stroke_mm", &CurvePoint::stroke_mm, "Amplitude of the holder's motion at the frequency, mm."},
      {"clearance_min_mm", &CurvePoint::clearance_min_mm, "Least clearance of the membrane, mm."},
      {"speed_max_cm_per_s", &CurvePoint::speed_max_cm_per_s, "Greatest speed of the fluid, cm/s."},
      {"scalar_stress_max_Pa", &CurvePoint::scalar_stress_max_Pa, "Greatest scalar stress in the fluid, Pa."},
      {"stressed_volume_mm3", &CurvePoint::stressed_volume_mm3,
       "Fluid beyond the threshold of stress, mm^3."},
  };
  return columns;
}

} // namespace undula::rom
