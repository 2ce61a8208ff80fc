#include "rom/curve/pump_period.hpp"

#include <cmath>
#include <numbers>

#include "rom/base/units.hpp"
#include "rom/curve/mode_amplitudes.hpp"

namespace undula::rom {
namespace {

/// sin(2 pi n / n_t), n = 0 .. n_t - 1.
Eigen::RowVectorXd sine_of_holder(Eigen::Index steps) {
  Eigen::RowVectorXd sine(steps);
  for (Eigen::Index n = 0; n < steps; ++n)
    sine[n] = std::sin(2 * std::numbers::pi * static_cast<double>(n) / static_cast<double>(steps));
  return sine;
}

} // namespace

Eigen::MatrixXd axial_displacement(const Operators& operators, const PeriodicSolver& solver, double stroke_cm,
                                   const PeriodicState& state) {
  Eigen::MatrixXd axial = operators.envelope * solver.at_steps(state.displacement);
  const Eigen::RowVectorXd sine = sine_of_holder(axial.cols());
  for (Eigen::Index n = 0; n < axial.cols(); ++n)
    axial.col(n) += operators.envelope_imposed * (stroke_cm * sine[n]);
  return axial;
}

PumpPeriod pump_period(const Model& model, double frequency_Hz, double stroke_mm, double head_mmHg,
                       const HqOptions& options) {
  const ModeAmplitudes amplitudes = mode_amplitudes(model, frequency_Hz, stroke_mm, head_mmHg, options);
  const Operators& operators = model.operators;
  PumpPeriod period;
  period.time_s = amplitudes.time_s;
  period.outflow_l_per_min =
      (operators.outflow.transpose() * amplitudes.velocity).transpose() / units::cm3_per_s_per_l_per_min;
  period.inflow_l_per_min =
      (operators.inflow.transpose() * amplitudes.velocity).transpose() / units::cm3_per_s_per_l_per_min;
  period.holder_mm = stroke_mm * sine_of_holder(amplitudes.velocity.cols()).transpose();
  period.radius_mm = operators.envelope_radius / units::cm_per_mm;
  period.membrane_mm = (operators.envelope * amplitudes.displacement +
                        operators.envelope_imposed * amplitudes.holder_cm.transpose()) /
                       units::cm_per_mm;
  period.periodic = amplitudes.periodic;
  return period;
}

} // namespace undula::rom
