#include "rom/curve/projected_curve.hpp"

#include <cmath>

namespace undula::rom {
namespace {

CurvePoint point_of(const HqPoint& answer) {
  CurvePoint point;
  point.head_mmHg = answer.head_mmHg;
  point.flow_l_per_min = answer.flow_l_per_min;
  point.inflow_l_per_min = answer.inflow_l_per_min;
  point.spread_l_per_min = answer.spread_l_per_min;
  point.error_l_per_min = answer.error_l_per_min;
  point.inside_training_box = answer.inside_training_box;
  point.power_mW = answer.hydraulic_power_mW;
  point.periods = answer.marched_periods;
  point.periodic = answer.converged && std::isfinite(answer.flow_l_per_min);
  if (!std::isfinite(answer.flow_l_per_min))
    point.reason = "the reduced model has no finite state there";
  else if (!answer.converged)
    point.reason = "no periodic state was found: the flow is the mean of the last period";
  return point;
}

} // namespace

std::vector<CurvePoint> projected_curve(const Model& model, double frequency_Hz, double stroke_mm,
                                        std::span<const double> heads_mmHg,
                                        const std::function<void()>& on_point) {
  HqOptions options;
  options.on_point = on_point;
  std::vector<CurvePoint> points;
  for (const auto& answer : hq_curve(model, frequency_Hz, stroke_mm, heads_mmHg, options))
    points.push_back(point_of(answer));
  return points;
}

} // namespace undula::rom
