// The quadratic term of the reduced model: C(b) a for many time points at once.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "rom/fixed_domain/panel_product.hpp"

namespace undula::rom {

/// Convection tensor T(i, j, k) = convection[k](i, j), arranged for products over many time points. Where
/// every convection[k] is skew (to round-off), only its strictly lower triangle is kept and multiplied.
class Convection {
public:
  explicit Convection(const std::vector<Eigen::MatrixXd>& convection);

  bool skew() const { return skew_; }

  /// C(b_n) for every column b_n of `b` (nu x m): one column per time point, to be used by apply() only.
  void matrices(const Eigen::MatrixXd& b, Eigen::MatrixXd& c) const { by_advector_.multiply(b, c); }

  /// Derivative of C(b_n) a_n with respect to b_n, nu x nu (column-major) in the top nu * nu entries of a
  /// column.
  void derivatives(const Eigen::MatrixXd& a, Eigen::MatrixXd& c) const { by_advected_.multiply(a, c); }

  /// f_n = C(b_n) a_n for every column; c from matrices(); f is nu x m.
  void apply(const Eigen::MatrixXd& c, const Eigen::MatrixXd& a, Eigen::MatrixXd& f) const;

  /// f_n += (derivative at n) b_n for every column; c from derivatives().
  void add_derivative(const Eigen::MatrixXd& c, const Eigen::MatrixXd& b, Eigen::MatrixXd& f) const;

private:
  Eigen::Index size_ = 0;
  bool skew_ = false;
  PanelProduct by_advector_; ///< rows (i, j), i > j only if skew; columns k
  PanelProduct by_advected_; ///< rows (i, k); columns j
};

} // namespace undula::rom
