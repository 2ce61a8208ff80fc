#include "rom/curve/hq_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <sstream>

#include "rom/base/error.hpp"
#include "rom/base/units.hpp"
#include "rom/curve/error_estimate.hpp"
#include "rom/curve/pump_period.hpp"
#include "rom/fixed_domain/condense.hpp"
#include "rom/fixed_domain/continuation.hpp"

namespace undula::rom {
namespace {

void set_envelope(const Operators& operators, const PeriodicSolver& solver, double stroke_cm,
                  const PeriodicState& state, HqPoint& point) {
  const Eigen::MatrixXd axial = axial_displacement(operators, solver, stroke_cm, state);
  point.envelope_low_mm = axial.rowwise().minCoeff() / units::cm_per_mm;
  point.envelope_high_mm = axial.rowwise().maxCoeff() / units::cm_per_mm;
}

} // namespace

void check_operating_point(double frequency_Hz, double stroke_mm, std::span<const double> heads_mmHg) {
  const auto fail = [](const std::string& what, double seen, const std::string& unit,
                       const std::string& allowed) {
    std::ostringstream text;
    text << seen << " " << unit;
    throw InputError(what, text.str(), allowed, "operating point of the HQ curve");
  };
  if (!(frequency_Hz > 0) || !std::isfinite(frequency_Hz))
    fail("the frequency must be positive", frequency_Hz, "Hz", "> 0");
  if (!(stroke_mm > 0) || !std::isfinite(stroke_mm))
    fail("the stroke must be positive", stroke_mm, "mm", "> 0");
  for (const double head : heads_mmHg)
    if (!std::isfinite(head)) fail("the head must be a finite number", head, "mmHg", "finite");
}

std::vector<std::string> outside_training_box(const TrainingBox& box, double frequency_Hz, double drive,
                                              std::span<const double> heads_mmHg, const DriveUnit& unit) {
  std::vector<std::string> lines;
  tell_outside("frequency", "Hz", frequency_Hz, box.frequency_low_Hz, box.frequency_high_Hz, lines);
  tell_outside(unit.name, unit.unit, drive, box.stroke_low_mm, box.stroke_high_mm, lines);
  for (const double head : heads_mmHg)
    tell_outside("head", "mmHg", head, box.head_low_mmHg, box.head_high_mmHg, lines);
  return lines;
}

void tell_outside(const std::string& name, const std::string& unit, double value, double low, double high,
                  std::vector<std::string>& lines) {
  if (parts_outside(value, low, high) == 0) return;
  std::ostringstream text;
  text << name << " " << value << " " << unit << " is outside the trained " << low << " to " << high << " "
       << unit;
  lines.push_back(text.str());
}

std::vector<HqPoint> hq_curve(const Model& model, double frequency_Hz, double stroke_mm,
                              std::span<const double> heads_mmHg, const HqOptions& options) {
  check_operating_point(frequency_Hz, stroke_mm, heads_mmHg);
  const Operators operators = condense_pressure(model.operators);
  const double stroke = units::length_from_mm(stroke_mm);
  PeriodicSolver solver(operators, frequency_Hz, model.steps_per_period, options.periodic);
  std::optional<FlowIndicator> indicator;
  if (options.estimate_errors) indicator.emplace(model.operators, frequency_Hz, model.steps_per_period);

  std::vector<double> heads(heads_mmHg.size());
  std::transform(heads_mmHg.begin(), heads_mmHg.end(), heads.begin(), units::pressure_from_mmHg);
  std::vector<HqPoint> points(heads.size());
  HeadContinuation continuation;
  for (const auto i : HeadContinuation::order(heads)) {
    const auto state = solver.solve(stroke, heads[i], continuation.guess(heads[i]));
    if (state.direct) continuation.add(heads[i], state.velocity);

    auto& point = points[i];
    point.head_mmHg = heads_mmHg[i];
    point.flow_l_per_min = units::flow_to_l_per_min(state.mean_outflow);
    point.inflow_l_per_min = units::flow_to_l_per_min(state.mean_inflow);
    point.spread_l_per_min = units::flow_to_l_per_min(state.outflow_spread);
    constexpr double erg_per_s_per_mW = 1e4;
    point.hydraulic_power_mW = heads[i] * state.mean_outflow / erg_per_s_per_mW;
    point.converged = state.converged;
    point.direct = state.direct;
    point.newton_iterations = state.newton_iterations;
    point.krylov_iterations = state.krylov_iterations;
    point.marched_periods = state.marched_periods;
    point.inside_training_box =
        outside_training_box(model.box, frequency_Hz, stroke_mm, heads_mmHg.subspan(i, 1)).empty();
    set_envelope(operators, solver, stroke, state, point);

    point.error_calibrated = model.error_safety > 0 || model.error_floor_l_per_min > 0;
    point.indicator_l_per_min = point.error_l_per_min = std::numeric_limits<double>::quiet_NaN();
    if (indicator) {
      point.indicator_l_per_min = units::flow_to_l_per_min((*indicator)(stroke, heads[i], state));
      const double safety = point.error_calibrated ? model.error_safety : 1.0;
      point.error_l_per_min =
          growth_outside_box(model.box, frequency_Hz, stroke_mm, point.head_mmHg) *
          (safety * point.indicator_l_per_min + model.error_floor_l_per_min + point.spread_l_per_min);
    }
    if (options.on_point) options.on_point();
  }
  return points;
}

} // namespace undula::rom
