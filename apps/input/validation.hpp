// The benchmark's algorithm: compare a model with a measured curve at a few heads.
#pragma once

#include <span>
#include <vector>

#include "apps/input/measured_curve.hpp"

namespace undula::apps {

/// One compared head; flows in l/min.
struct ValidatedPoint {
  ExtractedPoint measured;
  double computed_l_per_min = 0;
};

/// A comparison. The norm is sqrt(sum (computed - measured)^2) in l/min, as the benchmark reports it.
struct Validation {
  std::vector<ValidatedPoint> points;
  double norm_to_fit_l_per_min = 0;     ///< measured = the quadratic fit
  double norm_to_nearest_l_per_min = 0; ///< measured = the nearest sample
};

/// Compares computed flows (l/min) at heads, in the order given. Throws InputError for heads outside the
/// measured range.
Validation validate(const MeasuredCurve& curve, std::span<const double> heads_mmHg,
                    std::span<const double> computed_l_per_min);

} // namespace undula::apps
