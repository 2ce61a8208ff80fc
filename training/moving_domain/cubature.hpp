// Which parts of the cut and cells of the solids stand for all, and with which weights.
#pragma once

#include "training/campaign/moving_snapshots.hpp"

namespace undula::training {

struct Cubature {
  std::vector<double> part_weights, cell_weights; ///< see ReducedSpace
  int parts = 0, cells = 0;                       ///< with a weight > 0
  double part_error = 0, cell_error = 0;          ///< of the projected forces of all snapshots that were used
};

/// Weights >= 0 such that the forces on `basis` that the chosen parts (cells) exert at the snapshots of
/// `runs` add up to those of all, but for the part `tolerance`; at least the volume of the fluid is met as
/// well as that. Forces of fluid and interface are those of a whole step (inertia, convection, viscosity,
/// pressure, penalties); of solids, elastic and viscous ones. Moves the domain of `prepared` and brings it
/// back.
Cubature choose_cubature(PreparedScene& prepared, const Scene& scene, const Eigen::MatrixXd& basis,
                         int pressure_modes, std::span<const RunRecord> runs, double tolerance);

} // namespace undula::training
