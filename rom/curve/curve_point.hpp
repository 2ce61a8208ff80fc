// One head of a head-flow curve, whatever level computed it.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>

namespace undula::rom {

/// Surface units. NaN: the level does not know the number, or the numerics failed.
struct CurvePoint {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  double head_mmHg = 0;
  double flow_l_per_min = unknown; ///< mean out of the outlet; NaN where the numerics failed
  double inflow_l_per_min = unknown;
  /// Largest minus smallest mean of the last three periods, or of those that count where none repeats.
  double spread_l_per_min = unknown;
  double standard_error_l_per_min = unknown; ///< of the mean over periods that differ, see settled_mean.hpp
  int averaged_periods = 1;                  ///< the last ones, that the means are of
  double error_l_per_min = unknown;          ///< |error| that the level expects of itself; infinite: unknown
  std::optional<bool> inside_training_box;   ///< of a reduced model; nothing for other levels
  double power_mW = unknown;                 ///< hydraulic: head times flow
  double holder_power_mW = unknown;          ///< put in by the actuator
  double stroke_mm = unknown;                ///< amplitude of the holder's fundamental
  double stroke_2f_mm = unknown, stroke_3f_mm = unknown; ///< of its parts at twice and three times f
  double phase_degrees = unknown;                        ///< of the holder behind the drive
  double phase_2f_degrees = unknown,
         phase_3f_degrees = unknown; ///< the same of the parts, in their own periods
  double offset_mm = unknown;        ///< mean displacement of the holder
  /// Force of the holder on membrane and fluid per stroke, fundamentals: in phase with the displacement and
  /// a quarter of a period ahead of it.
  double reaction_in_phase_N_per_mm = unknown, reaction_quadrature_N_per_mm = unknown;
  double actuator_power_mW = unknown;   ///< of Drive::voltage
  double electrical_power_mW = unknown; ///< of Drive::voltage with the resistance of the coil
  double efficiency_percent = unknown;  ///< hydraulic power of the electrical, else actuator's, else holder's
  /// What the blood sees, of finite elements: see blood_stress.hpp. The percentage compares designs alone.
  double haemolysis_percent = unknown, scalar_stress_max_Pa = unknown, stressed_volume_mm3 = unknown;
  double speed_max_cm_per_s = unknown, clearance_min_mm = unknown;
  /// Of a peristaltic pump: see hose_observation.hpp. The ripple is largest minus smallest outflow, the leak
  /// flows backwards through the narrowest place of the hose.
  double flow_per_turn_ml = unknown, ripple_l_per_min = unknown, leak_l_per_min = unknown;
  double torque_N_m = unknown, torque_max_N_m = unknown, roller_force_max_N = unknown;
  double outlet_pressure_min_mmHg = unknown, outlet_pressure_max_mmHg = unknown;
  /// Where solids move through the elements: the least number of elements across a film, and the part of the
  /// averaged periods with fewer than four.
  double film_elements_min = unknown, film_unresolved_percent = unknown;
  int periods = 0; ///< computed at this head
  bool periodic = false;
  std::string reason; ///< why it is not, else empty
  std::string tier;   ///< of several levels the one that answered; empty: there is one alone
  std::string why;    ///< what each of them knew of its error
  std::map<std::string, double> seconds; ///< by phase, "total" among them
};

/// Hydraulic power over the electrical one, else the actuator's, else the holder's, %; NaN: none is known and
/// positive.
double efficiency_percent(const CurvePoint& point);

} // namespace undula::rom
