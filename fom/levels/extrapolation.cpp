#include "fom/levels/extrapolation.hpp"

#include <Eigen/QR>

namespace undula::fom {

Eigen::VectorXd extrapolation_weights(const Eigen::MatrixXd& differences) {
  // Minimise over gamma with sum 1 by eliminating the last weight.
  const Eigen::Index m = differences.cols();
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(m);
  if (m == 1) {
    weights[0] = 1;
    return weights;
  }
  const Eigen::MatrixXd reduced = differences.leftCols(m - 1).colwise() - differences.col(m - 1);
  const Eigen::VectorXd free = reduced.colPivHouseholderQr().solve(-differences.col(m - 1));
  weights.head(m - 1) = free;
  weights[m - 1] = 1 - free.sum();
  return weights;
}

} // namespace undula::fom
