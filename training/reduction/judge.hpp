// The reduced model against full-order runs it has not seen.
#pragma once

#include <span>

#include "rom/fixed_domain/model.hpp"
#include "training/reduction/bases.hpp"

namespace undula::training {

/// One full-order run in the coordinates of the reduced model.
struct ProjectedRun {
  OperatingPoint point;
  bool held_out = false;
  double flow = 0;        ///< mean outflow of the last period, cm^3/s
  double flow_spread = 0; ///< max - min of the means of the last periods, cm^3/s
  double fom_seconds = 0;
  std::vector<int> steps;        ///< of the snapshots of the last period, modulo the period
  Eigen::MatrixXd velocity;      ///< (mode, snapshot): kinetic-energy products with the velocity basis
  Eigen::VectorXd velocity_norm; ///< squared kinetic-energy norm, by snapshot
  Eigen::MatrixXd probes;        ///< (probe, snapshot): axial displacement, cm
};

ProjectedRun project_run(const PreparedScene& prepared, const Scene& scene, const Bases& bases,
                         const RunRecord& run, bool held_out);

/// Errors of a reduced model at one run.
struct RunErrors {
  double flow = 0;          ///< mean outflow, ROM, cm^3/s
  double velocity = 0;      ///< relative L2 over a period
  double best_velocity = 0; ///< the same of the best approximation in the basis
  double envelope = 0;      ///< relative L2 of the lowest and highest position along the probes
  double milliseconds = 0;  ///< of the reduced solve, factorisations included
  bool converged = false;
};

/// `velocity_modes` etc. as in rom::restrict_operators.
RunErrors judge_run(const rom::Operators& full, int velocity_modes, int pressure_modes,
                    int displacement_modes, int steps_per_period, const ProjectedRun& run);

/// One row of the table of modes against error, over the held-out runs.
struct ModeRow {
  int velocity_modes = 0, supremizers = 0, pressure_modes = 0, displacement_modes = 0;
  double flow_worst = 0; ///< cm^3/s
  double velocity_mean = 0, velocity_worst = 0, best_velocity_worst = 0;
  double envelope_worst = 0;
  double milliseconds = 0; ///< per point, mean
  int not_converged = 0;
};

std::vector<ModeRow> mode_table(const rom::Operators& full, int steps_per_period,
                                std::span<const ProjectedRun> runs, std::span<const double> fractions);

/// Fills references and the error calibration of `model` from all runs. `model.operators` and
/// steps_per_period must be set.
void calibrate_model(rom::Model& model, std::span<const ProjectedRun> runs);

} // namespace undula::training
