// Restart-free GMRES for small, well preconditioned problems.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <vector>

namespace undula {

struct GmresResult {
  int iterations = 0;
  double relative_residual = 1; ///< |b - A x| / |b|, by the recurrence
};

/// Solves A x = b from x = 0 until |b - A x| <= tolerance |b| or `most` iterations. `apply(in, out)` sets out
/// = A in; all are matrices of the shape of b, taken as one vector.
template <class Apply>
GmresResult gmres(const Apply& apply, const Eigen::MatrixXd& b, Eigen::MatrixXd& x, double tolerance,
                  int most) {
  const auto size = b.size();
  x.setZero(b.rows(), b.cols());
  const double norm = b.norm();
  GmresResult result{0, norm > 0 ? 1.0 : 0.0};
  if (!(norm > 0)) return result;

  Eigen::MatrixXd basis(size, most + 1), hessenberg = Eigen::MatrixXd::Zero(most + 1, most);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(most + 1);
  std::vector<Eigen::JacobiRotation<double>> rotations;
  basis.col(0) = b.reshaped() / norm;
  right[0] = norm;
  Eigen::MatrixXd in(b.rows(), b.cols()), out(b.rows(), b.cols());
  while (result.iterations < most && result.relative_residual > tolerance) {
    const int j = result.iterations;
    in.reshaped() = basis.col(j);
    apply(in, out);
    Eigen::VectorXd w = out.reshaped();
    // Twice is enough: classical Gram-Schmidt in two sweeps keeps the basis orthogonal to round-off.
    for (int sweep = 0; sweep < 2; ++sweep) {
      const Eigen::VectorXd overlap = basis.leftCols(j + 1).transpose() * w;
      w.noalias() -= basis.leftCols(j + 1) * overlap;
      hessenberg.col(j).head(j + 1) += overlap;
    }
    const double length = w.norm();
    hessenberg(j + 1, j) = length;
    auto column = hessenberg.col(j);
    for (int i = 0; i < j; ++i)
      column.applyOnTheLeft(i, i + 1, rotations[static_cast<std::size_t>(i)].adjoint());
    rotations.emplace_back().makeGivens(column[j], column[j + 1]);
    column.applyOnTheLeft(j, j + 1, rotations.back().adjoint());
    right.applyOnTheLeft(j, j + 1, rotations.back().adjoint());
    ++result.iterations;
    result.relative_residual = std::abs(right[j + 1]) / norm;
    if (!(length > 1e-15 * norm)) break; // the space is invariant: the solution is exact
    basis.col(j + 1) = w / length;
  }
  const int m = result.iterations;
  const Eigen::VectorXd weights =
      hessenberg.topLeftCorner(m, m).triangularView<Eigen::Upper>().solve(right.head(m));
  x.reshaped() = basis.leftCols(m) * weights;
  return result;
}

} // namespace undula
