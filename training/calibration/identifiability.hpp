// What a least-squares fit says of its parameters, from the Jacobian at the optimum.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace undula::training {

struct Identifiability {
  Eigen::VectorXd influence;       ///< root mean square change of the residuals over a parameter's range
  Eigen::VectorXd standard_error;  ///< unit of each parameter; infinite where the data do not fix it
  Eigen::MatrixXd correlation;     ///< of the estimates; NaN in rows and columns of unfixed parameters
  Eigen::VectorXd singular_values; ///< of the Jacobian per range, descending
  Eigen::MatrixXd directions;      ///< columns: unit vectors that belong to them, in parts of the ranges
  Eigen::VectorXd direction_error; ///< standard error along each, in parts of the ranges
  double condition = 0;            ///< largest over smallest singular value
  std::vector<int> without_influence;
  std::vector<std::array<int, 2>> correlated; ///< pairs beyond `strong_correlation`
  std::vector<int> unfixed_directions;        ///< the data say less of them than their range does
};

/// Correlation beyond which the data fix a combination of two parameters rather than both.
inline constexpr double strong_correlation = 0.95;

/// `jacobian`: residuals x parameters, per unit of each parameter. `range`: widths of their ranges.
/// `deviation`: standard deviation of every residual, independent of each other. A parameter whose influence
/// is below `least_influence` (unit of the residuals) has none, and is left out of the errors of the others.
/// A direction is unfixed where its standard error exceeds that of an even distribution over the range, 1 /
/// sqrt(12).
///
/// The fit minimises the plain sum of squares, so the covariance of its estimates is
/// J^+ diag(deviation^2) J^+T, J^+ the pseudoinverse.
Identifiability identifiability(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& range,
                                const Eigen::VectorXd& deviation, double least_influence);

} // namespace undula::training
