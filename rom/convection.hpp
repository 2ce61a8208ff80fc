// The quadratic term of the reduced model: C(b) a for many time points at once.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace undula::rom {

/// Convection tensor T(i, j, k) = convection[k](i, j), arranged for products over many time points. Where
/// every convection[k] is skew (to round-off), only its lower triangle is kept and multiplied.
class Convection {
public:
  Convection() = default;
  explicit Convection(const std::vector<Eigen::MatrixXd>& convection);

  int size() const { return size_; }
  bool skew() const { return skew_; }

  /// C(b_n) for every column b_n of `b` (nu x m): one column of nu * nu entries (column-major C) per time
  /// point.
  void matrices(const Eigen::MatrixXd& b, Eigen::MatrixXd& c) const;

  /// B(a_n), the derivative of C(b) a_n with respect to b, laid out as in matrices().
  void derivatives(const Eigen::MatrixXd& a, Eigen::MatrixXd& c) const;

private:
  int size_ = 0;
  bool skew_ = false;
  Eigen::MatrixXd by_advector_; // rows (i, j), i > j only if skew; columns k
  Eigen::MatrixXd by_advected_; // rows (i, k); columns j
};

/// f_n = c_n a_n for every column, with c as filled by Convection::matrices() or derivatives(). f is nu x m.
void apply_columns(const Eigen::MatrixXd& c, const Eigen::MatrixXd& a, Eigen::MatrixXd& f, bool accumulate);

} // namespace undula::rom
