// Conversions between the surface (mm, mmHg, l/min, N, mW) and the inside (cgs) of Undula.
// They are definitions, not physical properties; materials live in the scene.
#pragma once

namespace undula::units {

inline constexpr double dyn_per_cm2_per_mmHg = 1333.22387415; // 1 mmHg = 133.322387415 Pa
inline constexpr double cm3_per_s_per_l_per_min = 1000.0 / 60.0;
inline constexpr double cm_per_mm = 0.1;
inline constexpr double dyn_per_N = 1e5;
inline constexpr double N_per_dyn = 1e-5;
inline constexpr double mW_per_erg_per_s = 1e-4;

constexpr double pressure_from_mmHg(double p) { return p * dyn_per_cm2_per_mmHg; }
inline constexpr double dyn_per_cm2_per_Pa = 10;
constexpr double pressure_to_Pa(double p) { return p / dyn_per_cm2_per_Pa; }
constexpr double pressure_to_mmHg(double p) { return p / dyn_per_cm2_per_mmHg; }
constexpr double flow_from_l_per_min(double q) { return q * cm3_per_s_per_l_per_min; }
constexpr double flow_to_l_per_min(double q) { return q / cm3_per_s_per_l_per_min; }
constexpr double length_from_mm(double x) { return x * cm_per_mm; }
constexpr double volume_to_mm3(double v) { return v / (cm_per_mm * cm_per_mm * cm_per_mm); }
constexpr double length_to_mm(double x) { return x / cm_per_mm; }
constexpr double force_to_N(double f) { return N_per_dyn * f; }
constexpr double power_to_mW(double p) { return mW_per_erg_per_s * p; }

} // namespace undula::units
