#include "convection.hpp"

#include <cmath>

namespace undula::rom {
namespace {

bool is_skew(const std::vector<Eigen::MatrixXd>& convection) {
  double largest = 0, defect = 0;
  for (const auto& c : convection) {
    largest = std::max(largest, c.cwiseAbs().maxCoeff());
    defect = std::max(defect, (c + c.transpose()).cwiseAbs().maxCoeff());
  }
  return defect <= 1e-13 * largest;
}

} // namespace

Convection::Convection(const std::vector<Eigen::MatrixXd>& convection)
    : size_(static_cast<int>(convection.size())), skew_(is_skew(convection)) {
  const int n = size_;
  by_advector_.resize(skew_ ? n * (n - 1) / 2 : n * n, n);
  by_advected_.resize(n * n, n);
  for (int k = 0; k < n; ++k) {
    const auto& c = convection[static_cast<std::size_t>(k)];
    Eigen::Index row = 0;
    for (int j = 0; j < n; ++j) {
      for (int i = skew_ ? j + 1 : 0; i < n; ++i) by_advector_(row++, k) = c(i, j);
      by_advected_.col(j).segment(k * n, n) = c.col(j);
    }
  }
}

void Convection::matrices(const Eigen::MatrixXd& b, Eigen::MatrixXd& c) const {
  const int n = size_;
  if (!skew_) {
    c.noalias() = by_advector_ * b;
    return;
  }
  const Eigen::MatrixXd lower = by_advector_ * b;
  c.resize(n * n, b.cols());
  for (Eigen::Index point = 0; point < b.cols(); ++point) {
    const double* from = lower.col(point).data();
    double* to = c.col(point).data();
    for (int j = 0; j < n; ++j) {
      to[j * n + j] = 0;
      for (int i = j + 1; i < n; ++i, ++from) {
        to[j * n + i] = *from;
        to[i * n + j] = -*from;
      }
    }
  }
}

void Convection::derivatives(const Eigen::MatrixXd& a, Eigen::MatrixXd& c) const {
  c.noalias() = by_advected_ * a;
}

void apply_columns(const Eigen::MatrixXd& c, const Eigen::MatrixXd& a, Eigen::MatrixXd& f, bool accumulate) {
  const auto n = a.rows();
  if (!accumulate) f.setZero(n, a.cols());
  for (Eigen::Index point = 0; point < a.cols(); ++point)
    f.col(point).noalias() += Eigen::Map<const Eigen::MatrixXd>(c.col(point).data(), n, n) * a.col(point);
}

} // namespace undula::rom
