// One period of a projected model's periodic state, as it goes in time.
#pragma once

#include <Eigen/Core>

#include "rom/curve/hq_curve.hpp"

namespace undula::rom {

/// n_t instants t = 0, T / n_t, ..., surface units. The holder is at stroke * sin(2 pi t / T).
struct PumpPeriod {
  Eigen::VectorXd time_s;            ///< n_t
  Eigen::VectorXd outflow_l_per_min; ///< n_t, positive out of the outlet
  Eigen::VectorXd inflow_l_per_min;  ///< n_t, positive into the inlet
  Eigen::VectorXd holder_mm;         ///< n_t
  Eigen::VectorXd radius_mm;         ///< n_probe: places along the membrane's mid-plane
  Eigen::MatrixXd membrane_mm;       ///< n_probe x n_t, axial displacement there
  bool periodic = false;             ///< false: the last period of a march that does not repeat
};

/// The period behind the point that hq_curve gives for one head alone: its mean outflow, envelope and
/// `converged` are those of the point. Throws InputError as check_operating_point, NumericsError where the
/// model has no finite state.
PumpPeriod pump_period(const Model& model, double frequency_Hz, double stroke_mm, double head_mmHg,
                       const HqOptions& options = {});

/// Axial displacement of the membrane, n_probe x n_t, cm.
Eigen::MatrixXd axial_displacement(const Operators& operators, const PeriodicSolver& solver, double stroke_cm,
                                   const PeriodicState& state);

} // namespace undula::rom
