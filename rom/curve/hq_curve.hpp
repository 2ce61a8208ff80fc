// Head-flow curves from a reduced model.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "rom/fixed_domain/model.hpp"
#include "rom/fixed_domain/periodic.hpp"

namespace undula::rom {

struct HqOptions {
  /// How the periodic state is found (periodic.direct = false: the plain march). Looser than PeriodicOptions
  /// on its own: the flow still has six digits, far more than the model deserves, at half the time.
  PeriodicOptions periodic{.tolerance = 1e-6, .tail_tolerance = 1e-4};
  bool estimate_errors = true;    ///< false: error_l_per_min stays NaN
  std::function<void()> on_point; ///< called after every point; what it throws ends the curve
};

/// One operating point of the pump in its periodic state, surface units.
struct HqPoint {
  double head_mmHg = 0;
  double flow_l_per_min = 0;   ///< mean outflow over a period, positive out of the outlet
  double inflow_l_per_min = 0; ///< mean inflow over a period, positive into the inlet
  /// Estimated |error| of the flow against the full-order model: safety * indicator + floor of the model,
  /// plus the spread; outside of the training box times growth_outside_box. Infinity where the estimate
  /// failed or the point is far outside, NaN where none was asked for.
  double error_l_per_min = 0;
  double indicator_l_per_min = 0; ///< |Q_N - Q_M|, see FlowIndicator
  bool error_calibrated = false;  ///< false: the model has no held-out calibration and safety = 1, floor = 0
  bool inside_training_box = false; ///< frequency, stroke and head all inside
  bool converged = false;           ///< the state is periodic to tolerance
  bool direct = false; ///< found directly; false: the plain march was used (as asked for, or as fallback)
  double spread_l_per_min = 0;      ///< max - min of the last periods' means if marched; 0 if direct
  double hydraulic_power_mW = 0;    ///< head * flow
  Eigen::VectorXd envelope_low_mm;  ///< n_probe: least axial displacement of the membrane over a period
  Eigen::VectorXd envelope_high_mm; ///< n_probe: greatest
  int newton_iterations = 0, krylov_iterations = 0, marched_periods = 0;
};

/// Periodic states at the given heads (mmHg, any order, repeats allowed); the points come in the order of the
/// heads. Throws InputError as check_operating_point. A point outside the training box is answered with
/// inside_training_box = false: the caller must show it.
std::vector<HqPoint> hq_curve(const Model& model, double frequency_Hz, double stroke_mm,
                              std::span<const double> heads_mmHg, const HqOptions& options = {});

/// Throws InputError for a frequency or stroke that is not positive, or a head that is not finite.
void check_operating_point(double frequency_Hz, double stroke_mm, std::span<const double> heads_mmHg);

/// What drives the pump of a box whose stroke may stand for something else.
struct DriveUnit {
  const char* name = "stroke";
  const char* unit = "mm";
};

/// Adds a line where a value leaves a trained range ("frequency 150 Hz is outside the trained 80 to 140 Hz").
void tell_outside(const std::string& name, const std::string& unit, double value, double low, double high,
                  std::vector<std::string>& lines);

/// One line for each parameter that leaves the training box (tell_outside). Empty: all inside.
std::vector<std::string> outside_training_box(const TrainingBox& box, double frequency_Hz, double drive,
                                              std::span<const double> heads_mmHg, const DriveUnit& unit = {});

} // namespace undula::rom
