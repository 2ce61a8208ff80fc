#include "rom/curve/mode_amplitudes.hpp"

#include <cmath>
#include <numbers>

#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"
#include "rom/fixed_domain/condense.hpp"

namespace undula::rom {
namespace {

/// The scheme's difference of a periodic function at its steps, per s.
Eigen::RowVectorXd periodic_rate(const Eigen::VectorXd& values, double step_s) {
  const Eigen::Index n = values.size();
  Eigen::RowVectorXd rate(n);
  for (Eigen::Index i = 0; i < n; ++i)
    rate[i] = (bdf2_weights[0] * values[i] + bdf2_weights[1] * values[(i + n - 1) % n] +
               bdf2_weights[2] * values[(i + n - 2) % n]) /
              step_s;
  return rate;
}

} // namespace

ModeAmplitudes mode_amplitudes(const Model& model, double frequency_Hz, double stroke_mm, double head_mmHg,
                               const HqOptions& options) {
  check_operating_point(frequency_Hz, stroke_mm, std::span(&head_mmHg, 1));
  const Operators& full = model.operators;
  const Operators operators = condense_pressure(full);
  const double stroke = units::length_from_mm(stroke_mm);
  PeriodicSolver solver(operators, frequency_Hz, model.steps_per_period, options.periodic);
  const auto state = solver.solve(stroke, units::pressure_from_mmHg(head_mmHg));
  if (!std::isfinite(state.mean_outflow))
    throw NumericsError("the reduced model has no finite state",
                        plain_number(frequency_Hz) + " Hz, " + plain_number(stroke_mm) + " mm, " +
                            plain_number(head_mmHg) + " mmHg",
                        "an operating point in the training box");
  ModeAmplitudes result;
  result.velocity = solver.at_steps(state.velocity);
  result.displacement = solver.at_steps(state.displacement);
  const Eigen::Index steps = result.velocity.cols();
  const auto n = static_cast<double>(steps);
  result.time_s = Eigen::VectorXd::LinSpaced(steps, 0, n - 1) / (n * frequency_Hz);
  result.holder_cm.resize(steps);
  for (Eigen::Index i = 0; i < steps; ++i)
    result.holder_cm[i] = stroke * std::sin(2 * std::numbers::pi * static_cast<double>(i) / n);
  const Eigen::MatrixXd y = solver.at_steps(state.y);
  result.pressure =
      operators.pressure_modes == full.pressure_modes
          ? Eigen::MatrixXd(y.middleRows(full.velocity_modes, full.pressure_modes))
          : recovered_pressure(full, y, periodic_rate(result.holder_cm, 1 / (n * frequency_Hz)));
  result.periodic = state.converged;
  return result;
}

} // namespace undula::rom
