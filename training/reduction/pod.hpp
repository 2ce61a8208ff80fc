// Proper orthogonal decomposition of snapshots in a given inner product.
#pragma once

#include <petscmat.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace undula::training {

struct PodOptions {
  int max_modes = 0;           ///< keep at most so many; 0: no bound
  double energy_tolerance = 0; ///< keep the fewest modes whose tail energy is <= this fraction of the energy
};

/// Modes v_1..v_r with v_i^T W v_j = delta_ij, by falling singular value. The sign of a mode is such that its
/// entry of largest modulus (the first of those within 1e-6 of it) is positive.
struct PodBasis {
  Eigen::MatrixXd modes;           ///< n_local x r: this rank's rows, unit of the snapshots / unit of ||.||_W
  Eigen::VectorXd singular_values; ///< sigma_1 >= sigma_2 >= ..., also those beyond r, in the unit of ||.||_W
  double energy = 0;               ///< sum_j ||x_j||_W^2
  double tail_energy = 0;          ///< energy not captured by the r modes
  double captured_energy = 0;      ///< 1 - tail_energy / energy
};

/// POD of the columns x_1..x_m of `snapshots` in the inner product of the symmetric positive semidefinite
/// `inner_product` W. Truncation contract: with P the W-orthogonal projection onto the r modes,
///
///   tail_energy = sum_j ||x_j - P x_j||_W^2 = sum_{k > r} sigma_k^2 <= energy_tolerance * energy
///
/// (the last bound unless max_modes cuts first), and no other r vectors give less. Singular values below
/// sqrt(1e-6 * energy_tolerance) or 1e-14, relative to the norm of all snapshots, are not resolved one by one
/// but counted in tail_energy. The order of the snapshots does not matter.
///
/// Collective over the communicator of W; `snapshots` holds the rows that this rank owns in W (n_local x m),
/// m the same on all ranks. The m x m problems are solved by SLEPc on every rank; m of a few thousand is
/// practical. SLEPc must be initialised.
///
/// Throws InputError for shapes that do not match or a tolerance outside [0, 1), NumericsError for snapshots
/// that are not finite or have no energy, and for a W that is not positive semidefinite on them.
PodBasis pod(const Eigen::MatrixXd& snapshots, Mat inner_product, const PodOptions& options);

/// The same on one rank with all rows.
PodBasis pod(const Eigen::MatrixXd& snapshots, const Eigen::SparseMatrix<double>& inner_product,
             const PodOptions& options);

} // namespace undula::training
