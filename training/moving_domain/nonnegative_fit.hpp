// Sparse non-negative least squares: few columns of many, each with a weight >= 0.
#pragma once

#include <Eigen/Core>

namespace undula::training {

struct NonnegativeFit {
  Eigen::VectorXd weights; ///< by column, >= 0; most are 0
  int columns = 0;         ///< with a weight > 0
  double error = 0;        ///< |G w - b| / |b|
};

/// The method of Lawson and Hanson (Solving Least Squares Problems, 1974, chapter 23) for min |G w - b|, w >=
/// 0, on the normal equations: one column more at a time, until |G w - b| <= tolerance |b|, `most` columns
/// have a weight, or no other column helps. `gram` = G^T G, `right` = G^T b, `square` = b^T b.
NonnegativeFit nonnegative_fit(const Eigen::MatrixXd& gram, const Eigen::VectorXd& right, double square,
                               double tolerance, int most);

} // namespace undula::training
