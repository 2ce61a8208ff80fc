#include "apps/input/validation.hpp"

#include <cmath>

namespace undula::apps {

Validation validate(const MeasuredCurve& curve, std::span<const double> heads_mmHg,
                    std::span<const double> computed_l_per_min) {
  Validation validation;
  double to_fit = 0;
  double to_nearest = 0;
  for (const ExtractedPoint& measured : extract_points(curve, heads_mmHg)) {
    const double computed = computed_l_per_min[validation.points.size()];
    to_fit += std::pow(computed - measured.fit_l_per_min, 2);
    to_nearest += std::pow(computed - measured.nearest_l_per_min, 2);
    validation.points.push_back({measured, computed});
  }
  validation.norm_to_fit_l_per_min = std::sqrt(to_fit);
  validation.norm_to_nearest_l_per_min = std::sqrt(to_nearest);
  return validation;
}

} // namespace undula::apps
