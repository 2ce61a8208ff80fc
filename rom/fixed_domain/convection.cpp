#include "rom/fixed_domain/convection.hpp"

#include <algorithm>

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

Eigen::Map<const Eigen::MatrixXd> square(const Eigen::MatrixXd& c, Eigen::Index point, Eigen::Index n) {
  return {c.col(point).data(), n, n};
}

} // namespace

Convection::Convection(const std::vector<Eigen::MatrixXd>& convection)
    : size_(std::ssize(convection)), skew_(is_skew(convection)) {
  const auto n = size_;
  Eigen::MatrixXd by_advector(skew_ ? n * (n - 1) / 2 : n * n, n), by_advected(n * n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto& c = convection[static_cast<std::size_t>(k)];
    Eigen::Index row = 0;
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto first = skew_ ? j + 1 : 0;
      by_advector.col(k).segment(row, n - first) = c.col(j).tail(n - first);
      row += n - first;
      by_advected.col(j).segment(k * n, n) = c.col(j);
    }
  }
  by_advector_ = PanelProduct(by_advector);
  by_advected_ = PanelProduct(by_advected);
}

void Convection::apply(const Eigen::MatrixXd& c, const Eigen::MatrixXd& a, Eigen::MatrixXd& f) const {
  const auto n = size_;
  f.resize(n, a.cols());
  for (Eigen::Index point = 0; point < a.cols(); ++point) {
    if (!skew_) {
      f.col(point).noalias() = square(c, point, n) * a.col(point);
      continue;
    }
    const double* lower = c.col(point).data();
    const auto from = a.col(point);
    auto to = f.col(point);
    to.setZero();
    for (Eigen::Index j = 0; j + 1 < n; ++j) {
      const auto below = n - j - 1;
      const Eigen::Map<const Eigen::VectorXd> column(lower, below);
      to.tail(below) += column * from[j];
      to[j] -= column.dot(from.tail(below));
      lower += below;
    }
  }
}

void Convection::add_derivative(const Eigen::MatrixXd& c, const Eigen::MatrixXd& b,
                                Eigen::MatrixXd& f) const {
  for (Eigen::Index point = 0; point < b.cols(); ++point)
    f.col(point).noalias() += square(c, point, size_) * b.col(point);
}

} // namespace undula::rom
