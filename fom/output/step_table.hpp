// The time series of a run: one row of surface units per step, and what a period of it says.
#pragma once

#include <limits>
#include <optional>

#include "fom/output/observables.hpp"
#include "fom/output/time_series.hpp"

namespace undula::fom {

/// What a row of a time series holds: that of a pump, or that of a scene that states its problem.
struct RowLayout {
  bool pump = true;
  bool per_depth = false; ///< plane: powers and energies per cm of depth
  bool moving = false;    ///< the fluid's domain moves
  bool recut = false;     ///< solids move through the elements
  std::vector<GeneralColumn> general;
  bool blood = false;      ///< a pump whose fluid has a resolved stress
  bool voltage = false;    ///< the holder is driven by a voltage
  bool hose = false;       ///< a peristaltic pump: rollers in place of membrane and holder
  bool hose_force = false; ///< one whose hose has a stated modulus
  bool elements = false;   ///< finite elements, whose scheme's own loss is known
};

/// Columns of time_series.csv, without "step".
std::vector<std::string> observation_columns(const RowLayout& layout = {});

/// One value per column.
std::vector<double> observation_row(const Observation& seen, const RowLayout& layout = {});

/// What one turn of a peristaltic pump comes to besides; see hose_observation.hpp.
struct TurnSummary {
  double volume_ml = 0;                      ///< out of the outlet
  double leak_l_per_min = 0, torque_N_m = 0; ///< means
  double torque_max_N_m = 0;
  double outlet_pressure_min_mmHg = 0, outlet_pressure_max_mmHg = 0;
  double roller_force_max_N = std::numeric_limits<double>::quiet_NaN(); ///< NaN without a modulus
};

/// What one period comes to. Flows in l/min.
struct PeriodSummary {
  int period = 0;               ///< from 1
  double outflow_l_per_min = 0; ///< mean
  double inflow_l_per_min = 0;  ///< mean
  double spread_l_per_min = 0;  ///< highest minus lowest outflow
  double input_power_mW = 0;    ///< mean power of the holder, and of the openings where they drive
  /// (holder + opening - viscous - stabilisation - damping - carried - contact - growth of kinetic and
  /// elastic energy) as a part of the input power: what the time scheme dissipates, and errors. 0 without
  /// input.
  double energy_gap = 0;
  /// The part of it that the time scheme takes by itself (EnergyTerms::scheme); NaN without finite elements.
  double scheme_loss = std::numeric_limits<double>::quiet_NaN();
  /// Mean distance of the extrapolated convecting velocity from the computed one; NaN without finite
  /// elements.
  double convection_error = std::numeric_limits<double>::quiet_NaN();
  double speed_max_cm_per_s = 0;
  double clearance_min_mm = 0;
  /// As in CurvePoint; NaN where solids do not move through the elements.
  double film_elements_min = std::numeric_limits<double>::quiet_NaN(),
         film_unresolved_percent = std::numeric_limits<double>::quiet_NaN();
  std::optional<TurnSummary> turn; ///< of peristaltic pumps
};

/// The complete periods of a pump's table with observation_columns.
std::vector<PeriodSummary> summarise_periods(const TimeSeries& table, int steps_per_period);

} // namespace undula::fom
