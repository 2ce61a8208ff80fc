#include "rom/fixed_domain/harmonics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace undula::rom {
namespace {

using Complex = std::complex<double>;

Complex phase(int k, int of) { return std::polar(1.0, 2 * std::numbers::pi * k / of); }

// Rows of c_k -> values of Re(c_k gain_k exp(i k t)) at `points` equal steps of the period.
template <class Gain>
Eigen::MatrixXd trigonometric(int coefficients, int points, Gain gain) {
  Eigen::MatrixXd matrix(coefficients, points);
  Eigen::VectorXcd circle(points), gains(coefficients / 2 + 1);
  for (int n = 0; n < points; ++n) circle[n] = phase(n, points);
  for (int k = 0; k < gains.size(); ++k) gains[k] = gain(k);
  for (int n = 0; n < points; ++n) {
    matrix(0, n) = gains[0].real();
    for (int row = 1; row < coefficients; ++row) {
      const int k = (row + 1) / 2;
      // k n is reduced modulo the period in integers: exact angles for large products.
      const Complex factor = gains[k] * circle[(static_cast<long>(k) * n) % points];
      matrix(row, n) = row % 2 == 1 ? factor.real() : -factor.imag();
    }
  }
  return matrix;
}

} // namespace

Harmonics::Harmonics(int steps_per_period, int harmonics)
    : steps_(steps_per_period),
      harmonics_(std::min(harmonics, steps_per_period / 2)),
      coefficients_(std::min(2 * harmonics_ + 1, steps_per_period)),
      points_(coefficients_ == steps_ ? steps_ : std::min(steps_, 3 * harmonics_ + 1)) {
  synthesis_ = trigonometric(coefficients_, points_, [](int) { return Complex(1.0); });
  extrapolated_ = trigonometric(coefficients_, points_,
                                [this](int k) { return 2.0 * phase(-k, steps_) - phase(-2 * k, steps_); });
  analysis_ = synthesis_.transpose() * (2.0 / points_);
  analysis_.col(0) *= 0.5;
  if (complete() && steps_ % 2 == 0) analysis_.col(coefficients_ - 1) *= 0.5;
}

Complex Harmonics::difference(int k) const {
  return 1.5 - 2.0 * phase(-k, steps_) + 0.5 * phase(-2 * k, steps_);
}

Eigen::MatrixXd Harmonics::synthesis_at_steps(int steps_per_period, int coefficients) {
  return trigonometric(coefficients, steps_per_period, [](int) { return Complex(1.0); });
}

} // namespace undula::rom
