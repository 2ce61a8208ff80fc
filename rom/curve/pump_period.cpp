#include "rom/curve/pump_period.hpp"

#include <cmath>
#include <numbers>

#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"
#include "rom/fixed_domain/condense.hpp"

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
  check_operating_point(frequency_Hz, stroke_mm, std::span(&head_mmHg, 1));
  const Operators operators = condense_pressure(model.operators);
  const double stroke = units::length_from_mm(stroke_mm);
  PeriodicSolver solver(operators, frequency_Hz, model.steps_per_period, options.periodic);
  const auto state = solver.solve(stroke, units::pressure_from_mmHg(head_mmHg));
  if (!std::isfinite(state.mean_outflow))
    throw NumericsError("the reduced model has no finite state",
                        plain_number(frequency_Hz) + " Hz, " + plain_number(stroke_mm) + " mm, " +
                            plain_number(head_mmHg) + " mmHg",
                        "an operating point in the training box");
  const Eigen::MatrixXd velocity = solver.at_steps(state.velocity);
  const Eigen::Index steps = velocity.cols();
  PumpPeriod period;
  period.time_s = Eigen::VectorXd::LinSpaced(steps, 0, static_cast<double>(steps - 1)) /
                  (static_cast<double>(steps) * frequency_Hz);
  period.outflow_l_per_min =
      (operators.outflow.transpose() * velocity).transpose() / units::cm3_per_s_per_l_per_min;
  period.inflow_l_per_min =
      (operators.inflow.transpose() * velocity).transpose() / units::cm3_per_s_per_l_per_min;
  period.holder_mm = stroke_mm * sine_of_holder(steps).transpose();
  period.radius_mm = operators.envelope_radius / units::cm_per_mm;
  period.membrane_mm = axial_displacement(operators, solver, stroke, state) / units::cm_per_mm;
  period.periodic = state.converged;
  return period;
}

} // namespace undula::rom
