#include "rom/curve/error_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rom/base/error.hpp"
#include "rom/fixed_domain/condense.hpp"

namespace undula::rom {
namespace {

// Modes of the smaller model: fewer by 30 %, at least one less, at least one.
int fewer(int modes) { return modes <= 1 ? modes : std::min(modes - 1, (7 * modes + 9) / 10); }

Operators coarse_operators(const Operators& full) {
  return restrict_operators(full, fewer(full.velocity_modes - full.supremizer_modes),
                            fewer(full.pressure_modes), fewer(full.displacement_modes));
}

// The indicator needs two digits, not eight.
PeriodicOptions coarse_options() {
  PeriodicOptions options;
  options.tolerance = 1e-4;
  options.tail_tolerance = 1e-2;
  options.march_periods = 0;
  return options;
}

struct Line {
  double safety = 0, floor = 0;
  double operator()(double indicator) const { return safety * indicator + floor; }
};

// Smallest mean of the line over the points, subject to lying above all of them: a linear programme in two
// unknowns, whose optimum is at a vertex. The vertices are the lines through two points, the level line and
// the line through the origin.
Line tightest(std::span<const double> x, std::span<const double> y) {
  const auto n = x.size();
  Line best{0, *std::max_element(y.begin(), y.end())};
  double best_mean = best.floor;
  const auto offer = [&](const Line& line) {
    if (!(line.safety >= 0 && line.floor >= 0 && std::isfinite(line.safety))) return;
    double mean = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (line(x[i]) < y[i] * (1 - 1e-12)) return;
      mean += line(x[i]) / static_cast<double>(n);
    }
    if (mean < best_mean) {
      best = line;
      best_mean = mean;
    }
  };
  double steepest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (y[i] > 0) steepest = std::max(steepest, y[i] / x[i]);
    for (std::size_t j = 0; j < i; ++j) {
      const double slope = (y[i] - y[j]) / (x[i] - x[j]);
      offer({slope, y[i] - slope * x[i]});
    }
  }
  offer({steepest, 0});
  return best;
}

} // namespace

FlowIndicator::FlowIndicator(const Operators& operators, double frequency_Hz, int steps_per_period)
    : coarse_(condense_pressure(coarse_operators(operators))),
      solver_(coarse_, frequency_Hz, steps_per_period, coarse_options()) {
  const int proper_modes = operators.velocity_modes - operators.supremizer_modes;
  const int kept_proper_modes = fewer(proper_modes);
  for (int i = 0; i < kept_proper_modes; ++i) kept_.push_back(i);
  for (int i = 0; i < coarse_.velocity_modes - kept_proper_modes; ++i) kept_.push_back(proper_modes + i);
}

double FlowIndicator::operator()(double stroke_cm, double head, const PeriodicState& state) {
  try {
    const auto coarse = solver_.solve(stroke_cm, head, state.velocity(kept_, Eigen::all));
    if (coarse.converged) return std::abs(coarse.mean_outflow - state.mean_outflow);
  } catch (const NumericsError&) {
    // Without a solution of the smaller model nothing is known about the error.
  }
  return std::numeric_limits<double>::infinity();
}

double parts_outside(double value, double low, double high) {
  // A bound that went through text or unit conversion still counts as inside.
  const double slack = 1e-9 * std::max(std::abs(low), std::abs(high));
  const double off = std::max({low - value, value - high, 0.0});
  if (off <= slack) return 0;
  return high > low ? off / (high - low) : std::numeric_limits<double>::infinity();
}

double growth_outside_box(const TrainingBox& box, double frequency_Hz, double stroke_mm, double head_mmHg) {
  // Of two at a time: of three, infinities come out as nan with some libraries.
  const double drive = std::hypot(parts_outside(frequency_Hz, box.frequency_low_Hz, box.frequency_high_Hz),
                                  parts_outside(stroke_mm, box.stroke_low_mm, box.stroke_high_mm));
  return growth_outside(std::hypot(drive, parts_outside(head_mmHg, box.head_low_mmHg, box.head_high_mmHg)));
}

double growth_outside(double d) {
  constexpr double known = 0.5, rise = 10;
  return d > known ? std::numeric_limits<double>::infinity() : std::pow(1 + rise * d, 2);
}

ErrorCalibration calibrate_error_estimate(std::span<const double> indicators,
                                          std::span<const double> true_errors) {
  const std::string where = "calibration of the error estimate on held-out points";
  if (indicators.size() != true_errors.size() || indicators.size() < 3)
    throw InputError(
        "the error estimate cannot be calibrated",
        std::to_string(indicators.size()) + " indicators, " + std::to_string(true_errors.size()) + " errors",
        "at least 3 of each, as many of one as of the other", where);
  for (const auto values : {indicators, true_errors})
    for (const double value : values)
      if (!std::isfinite(value) || value < 0)
        throw InputError("an indicator or error is not a size", std::to_string(value), "finite numbers >= 0",
                         where);

  ErrorCalibration result;
  for (std::size_t left_out = 0; left_out < indicators.size(); ++left_out) {
    std::vector<double> x(indicators.begin(), indicators.end()), y(true_errors.begin(), true_errors.end());
    x.erase(x.begin() + static_cast<std::ptrdiff_t>(left_out));
    y.erase(y.begin() + static_cast<std::ptrdiff_t>(left_out));
    const double estimate = tightest(x, y)(indicators[left_out]);
    const double error = true_errors[left_out];
    if (!(error > 0)) continue;
    // No finite factor covers an error where the others promised none; the fit to all points does.
    if (estimate > 0) result.worst_left_out = std::max(result.worst_left_out, error / estimate);
    if (error > estimate) ++result.left_out_violations;
  }
  const auto line = tightest(indicators, true_errors);
  const double widening = std::max(1.0, result.worst_left_out);
  result.safety = widening * line.safety;
  result.floor = widening * line.floor;
  return result;
}

} // namespace undula::rom
