// How far a flow of the reduced model can be trusted.
#pragma once

#include <span>
#include <vector>

#include "rom/fixed_domain/model.hpp"
#include "rom/fixed_domain/periodic.hpp"

namespace undula::rom {

/// Hierarchical indicator of the truncation error of the mean outflow: |Q_N - Q_M|, where M is the same model
/// with about 70 % of the modes of each field. As the modes fall in energy, Q_M is the worse of the two, and
/// what the last 30 % change says how much the modes left out may still change. It sees the truncation of the
/// basis only; error_safety and error_floor_l_per_min of the model, fitted on held-out full-order runs, scale
/// it to an error against the full-order model. It says nothing of the full-order model's own error.
class FlowIndicator {
public:
  FlowIndicator(const Operators& operators, double frequency_Hz, int steps_per_period);

  /// |Q_N - Q_M| in cm^3/s for a periodic state of the full basis. Infinity if the smaller model has no
  /// solution.
  double operator()(double stroke_cm, double head, const PeriodicState& state);

private:
  Operators coarse_;
  std::vector<int> kept_; ///< velocity modes of the full basis that the coarse one keeps
  PeriodicSolver solver_;
};

/// Factor on an estimate calibrated inside of the box, at a point outside of it: with d the distance from the
/// box in parts of its width in each direction, (1 + 10 d)^2, and infinity, that is unknown, beyond half a
/// width or where the box has no width. No measurement stands behind the growth; it says that the estimate is
/// worth less the farther the point is from every run that it was calibrated on.
double growth_outside_box(const TrainingBox& box, double frequency_Hz, double stroke_mm, double head_mmHg);

/// The same of the distance d.
double growth_outside(double d);

/// How far a value is outside of a range, in parts of its width: 0 inside, infinity outside of a range
/// without width.
double parts_outside(double value, double low, double high);

/// The estimate |error| <= safety * indicator + floor, and how well it does on points it was not fitted to.
struct ErrorCalibration {
  double safety = 0;
  double floor = 0; ///< unit of the errors
  /// Leave-one-out check: the largest error / estimate when each point is estimated from a fit to the others.
  /// Above 1 the fit has been widened by that factor, so that the final estimate covers it.
  double worst_left_out = 0;
  int left_out_violations = 0; ///< points with error above the estimate fitted to the others
};

/// Fits the tightest estimate (smallest mean over the points) that bounds every true error, safety and floor
/// >= 0, then widens both as the leave-one-out check demands. Both spans in the same unit and of the same
/// length; throws InputError for fewer than 3 points, unequal lengths, negative or non-finite values.
ErrorCalibration calibrate_error_estimate(std::span<const double> indicators,
                                          std::span<const double> true_errors);

} // namespace undula::rom
