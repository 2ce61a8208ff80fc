#include "training/reduction/judge.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include "fom/output/last_periods.hpp"
#include "rom/base/units.hpp"
#include "rom/curve/error_estimate.hpp"
#include "rom/fixed_domain/condense.hpp"
#include "rom/fixed_domain/periodic.hpp"
#include "training/campaign/recorded_run.hpp"

namespace undula::training {

namespace {

/// Lowest, then highest value of every row.
Eigen::VectorXd envelope_of(const Eigen::MatrixXd& values) {
  Eigen::VectorXd envelope(2 * values.rows());
  envelope << values.rowwise().minCoeff(), values.rowwise().maxCoeff();
  return envelope;
}

/// Indices of the velocity basis that a restricted model keeps, see rom::restrict_operators.
std::vector<int> kept_velocity(const rom::Operators& full, int velocity_modes, int pressure_modes) {
  std::vector<int> kept;
  for (int i = 0; i < velocity_modes; ++i) kept.push_back(i);
  const int proper = full.velocity_modes - full.supremizer_modes;
  for (int i = 0; i < std::min(full.supremizer_modes, pressure_modes); ++i) kept.push_back(proper + i);
  return kept;
}

} // namespace

ProjectedRun project_run(const PreparedScene& prepared, const Scene& scene, const Bases& bases,
                         const RunRecord& run, bool held_out) {
  const auto& disc = prepared.disc;
  ProjectedRun projected;
  projected.point = run.point;
  projected.held_out = held_out;
  const auto outflow = last_periods(run.cycles, "outflow_l_per_min");
  projected.flow = units::flow_from_l_per_min(outflow.mean);
  projected.flow_spread = units::flow_from_l_per_min(outflow.spread);
  projected.fom_seconds = run.seconds.at("total");

  const auto velocity_rows = velocity_unknowns(disc), solid_rows = displacement_unknowns(disc);
  const auto& velocity = run.snapshots.at(velocity_field).values;
  const auto& displacement = run.snapshots.at(displacement_field).values;
  const int count = scene.training.snapshots_per_period;
  const Eigen::Index first = velocity.cols() - count;
  projected.velocity.resize(bases.velocity.cols(), count);
  projected.velocity_norm.resize(count);
  projected.probes.resize(prepared.observation.probes.axial.rows(), count);
  const double dt = 1.0 / (run.point.frequency * scene.time.steps_per_period);
  Eigen::VectorXd full = Eigen::VectorXd::Zero(disc.unknowns());
  for (int k = 0; k < count; ++k) {
    full.setZero();
    full(velocity_rows) = velocity.col(first + k);
    const Eigen::VectorXd weighted = prepared.operators.mass * full;
    projected.velocity.col(k) = bases.velocity.transpose() * weighted;
    projected.velocity_norm[k] = full.dot(weighted);
    full.setZero();
    full(solid_rows) = displacement.col(first + k);
    projected.probes.col(k) = prepared.observation.probes.axial_displacement(full);
    const long step = std::lround(run.times[static_cast<std::size_t>(first + k)] / dt);
    projected.steps.push_back(static_cast<int>(step % scene.time.steps_per_period));
  }
  return projected;
}

RunErrors judge_run(const rom::Operators& full, int velocity_modes, int pressure_modes,
                    int displacement_modes, int steps_per_period, const ProjectedRun& run) {
  const auto reduced = rom::condense_pressure(
      rom::restrict_operators(full, velocity_modes, pressure_modes, displacement_modes));
  const auto begin = std::chrono::steady_clock::now();
  rom::PeriodicOptions options;
  options.march_periods = 0; // a direct failure is reported, not waited for
  rom::PeriodicSolver solver(reduced, run.point.frequency, steps_per_period, options);
  const auto state = solver.solve(run.point.stroke, run.point.head);
  RunErrors errors;
  errors.milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  errors.converged = state.converged;
  errors.flow = state.mean_outflow;
  if (!state.converged) return errors;
  const Eigen::MatrixXd velocity = solver.at_steps(state.velocity);
  const Eigen::MatrixXd displacement = solver.at_steps(state.displacement);
  const Eigen::MatrixXd exact = run.velocity(kept_velocity(full, velocity_modes, pressure_modes), Eigen::all);

  double error = 0, best = 0;
  Eigen::MatrixXd probes(run.probes.rows(), run.probes.cols());
  for (Eigen::Index k = 0; k < exact.cols(); ++k) {
    const int step = run.steps[static_cast<std::size_t>(k)];
    // The basis is orthonormal in the kinetic energy: |u - Phi a|^2 = |u|^2 - |Phi^T M u|^2 + |Phi^T M u -
    // a|^2.
    const double outside = run.velocity_norm[k] - exact.col(k).squaredNorm();
    best += outside;
    error += outside + (exact.col(k) - velocity.col(step)).squaredNorm();
    const double phase = 2 * std::numbers::pi * step / steps_per_period;
    probes.col(k) = reduced.envelope * displacement.col(step) +
                    reduced.envelope_imposed * (run.point.stroke * std::sin(phase));
  }
  const double norm = run.velocity_norm.sum();
  errors.velocity = std::sqrt(std::max(error, 0.0) / norm);
  errors.best_velocity = std::sqrt(std::max(best, 0.0) / norm);
  const Eigen::VectorXd envelope = envelope_of(run.probes);
  errors.envelope = (envelope_of(probes) - envelope).norm() / envelope.norm();
  return errors;
}

std::vector<ModeRow> mode_table(const rom::Operators& full, int steps_per_period,
                                std::span<const ProjectedRun> runs, std::span<const double> fractions) {
  std::vector<ModeRow> table;
  const auto part = [](double fraction, int modes) {
    return std::max(1, static_cast<int>(std::lround(fraction * modes)));
  };
  for (const double fraction : fractions) {
    ModeRow row;
    row.velocity_modes = part(fraction, full.velocity_modes - full.supremizer_modes);
    row.pressure_modes = part(fraction, full.pressure_modes);
    row.displacement_modes = part(fraction, full.displacement_modes);
    row.supremizers = std::min(full.supremizer_modes, row.pressure_modes);
    int counted = 0;
    for (const auto& run : runs) {
      if (!run.held_out) continue;
      const auto errors = judge_run(full, row.velocity_modes, row.pressure_modes, row.displacement_modes,
                                    steps_per_period, run);
      row.milliseconds += errors.milliseconds;
      ++counted;
      if (!errors.converged) {
        ++row.not_converged;
        continue;
      }
      row.flow_worst = std::max(row.flow_worst, std::abs(errors.flow - run.flow));
      row.velocity_mean += errors.velocity;
      row.velocity_worst = std::max(row.velocity_worst, errors.velocity);
      row.best_velocity_worst = std::max(row.best_velocity_worst, errors.best_velocity);
      row.envelope_worst = std::max(row.envelope_worst, errors.envelope);
    }
    row.milliseconds /= std::max(counted, 1);
    row.velocity_mean /= std::max(counted - row.not_converged, 1);
    table.push_back(row);
  }
  return table;
}

void calibrate_model(rom::Model& model, std::span<const ProjectedRun> runs) {
  const auto& full = model.operators;
  std::vector<double> indicators, true_errors;
  for (const auto& run : runs) {
    const auto errors = judge_run(full, full.velocity_modes - full.supremizer_modes, full.pressure_modes,
                                  full.displacement_modes, model.steps_per_period, run);
    rom::ReferencePoint reference;
    reference.frequency_Hz = run.point.frequency;
    reference.stroke_mm = units::length_to_mm(run.point.stroke);
    reference.head_mmHg = units::pressure_to_mmHg(run.point.head);
    reference.flow_l_per_min = units::flow_to_l_per_min(run.flow);
    reference.flow_spread_l_per_min = units::flow_to_l_per_min(run.flow_spread);
    reference.held_out = run.held_out;
    reference.rom_flow_l_per_min = units::flow_to_l_per_min(errors.flow);
    reference.velocity_error = errors.velocity;
    reference.envelope_error = errors.envelope;
    reference.fom_seconds = run.fom_seconds;
    model.references.push_back(reference);
    if (!run.held_out || !errors.converged) continue;
    const auto condensed = rom::condense_pressure(full);
    rom::PeriodicSolver solver(condensed, run.point.frequency, model.steps_per_period);
    const auto state = solver.solve(run.point.stroke, run.point.head);
    rom::FlowIndicator indicator(full, run.point.frequency, model.steps_per_period);
    indicators.push_back(units::flow_to_l_per_min(indicator(run.point.stroke, run.point.head, state)));
    true_errors.push_back(std::abs(reference.rom_flow_l_per_min - reference.flow_l_per_min));
  }
  // The calibration wants finite indicators and at least three points; without them the model says so itself.
  for (std::size_t i = indicators.size(); i-- > 0;)
    if (!std::isfinite(indicators[i])) {
      indicators.erase(indicators.begin() + static_cast<std::ptrdiff_t>(i));
      true_errors.erase(true_errors.begin() + static_cast<std::ptrdiff_t>(i));
    }
  if (indicators.size() < 3) return;
  const auto calibration = rom::calibrate_error_estimate(indicators, true_errors);
  model.error_safety = calibration.safety;
  model.error_floor_l_per_min = calibration.floor;
}

} // namespace undula::training
