// The limit of a sequence of vectors, estimated from a few of them.
#pragma once

#include <Eigen/Core>

namespace undula::fom {

/// Reduced rank extrapolation (Mesina 1977; Sidi 1991) of states z_0..z_m, one period apart: weights
/// gamma_0.. gamma_{m-1}, sum 1, that minimise |sum gamma_i (z_{i+1} - z_i)|. The limit of the sequence is
/// estimated by sum gamma_i z_{i+1}. Columns of `differences` are z_{i+1} - z_i in coordinates whose
/// Euclidean norm matters.
Eigen::VectorXd extrapolation_weights(const Eigen::MatrixXd& differences);

} // namespace undula::fom
