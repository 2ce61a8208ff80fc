#include "rom/fixed_domain/resolvent.hpp"

#include <cmath>

#include "rom/base/error.hpp"

namespace undula::rom {
namespace {

// Column pair (Re, Im) of harmonic k; the Nyquist harmonic of an even number of steps has a real part only.
Eigen::VectorXcd harmonic(const Eigen::MatrixXd& coefficients, int k) {
  if (k == 0) return coefficients.col(0).cast<std::complex<double>>();
  Eigen::VectorXcd value(coefficients.rows());
  value.real() = coefficients.col(2 * k - 1);
  if (2 * k < coefficients.cols())
    value.imag() = coefficients.col(2 * k);
  else
    value.imag().setZero();
  return value;
}

void set_harmonic(Eigen::MatrixXd& coefficients, int k, const Eigen::VectorXcd& value) {
  coefficients.col(k == 0 ? 0 : 2 * k - 1) = value.real();
  if (k > 0 && 2 * k < coefficients.cols()) coefficients.col(2 * k) = value.imag();
}

int harmonics_of(Eigen::Index columns) { return static_cast<int>(columns / 2); }

} // namespace

Resolvent::Resolvent(const Operators& operators, double frequency_Hz, int steps_per_period)
    : operators_(operators), symbols_(steps_per_period, 0), dt_(1.0 / (frequency_Hz * steps_per_period)) {}

void Resolvent::extend(int harmonics) {
  const int nu = operators_.velocity_modes, nv = operators_.displacement_modes;
  const auto n = operators_.mass.rows();
  for (int k = static_cast<int>(factors_.size()); k <= harmonics; ++k) {
    Eigen::MatrixXcd matrix = operators_.linear.cast<std::complex<double>>();
    if (k == 0) {
      matrix.rightCols(nv).setZero();
      matrix.bottomRightCorner(nv, nv) = operators_.stiffness.cast<std::complex<double>>();
    } else {
      matrix += rate(k) * operators_.mass;
      matrix.bottomRightCorner(nv, nv) += operators_.stiffness / rate(k);
    }
    factors_.emplace_back(matrix);
    const Eigen::MatrixXcd inverse = factors_.back().solve(Eigen::MatrixXcd::Identity(n, nu));
    if (!inverse.allFinite())
      throw NumericsError(
          "the linear part of the reduced model is singular", "harmonic " + std::to_string(k),
          "fewer pressure modes, or supremizers for them, or stiffer supports of the membrane");
    velocity_blocks_.push_back(inverse.topRows(nu));
  }
}

Eigen::MatrixXd Resolvent::solve(const Eigen::MatrixXd& force) const {
  Eigen::MatrixXd y(force.rows(), force.cols());
  for (int k = 0; k <= harmonics_of(force.cols()); ++k)
    set_harmonic(y, k, factors_[static_cast<std::size_t>(k)].solve(harmonic(force, k)));
  // At k = 0 the last rows hold the displacement; the velocity of a periodic membrane has no mean.
  return y;
}

Eigen::MatrixXd Resolvent::velocity_response(const Eigen::MatrixXd& force) const {
  Eigen::MatrixXd u(force.rows(), force.cols());
  for (int k = 0; k <= harmonics_of(force.cols()); ++k)
    set_harmonic(u, k, velocity_blocks_[static_cast<std::size_t>(k)] * harmonic(force, k));
  return u;
}

Eigen::MatrixXd Resolvent::displacement(const Eigen::MatrixXd& y) const {
  Eigen::MatrixXd d = y.bottomRows(operators_.displacement_modes);
  for (int k = 1; k <= harmonics_of(y.cols()); ++k) set_harmonic(d, k, harmonic(d, k) / rate(k));
  return d;
}

Eigen::MatrixXd Resolvent::holder_force(int coefficients) const {
  Eigen::MatrixXd force = Eigen::MatrixXd::Zero(operators_.mass.rows(), coefficients);
  const std::complex<double> holder(0.0, -1.0); // sin(w t) = Re(-i exp(i w t))
  const auto velocity = rate(1) * holder;
  set_harmonic(force, 1,
               operators_.imposed_mass * (rate(1) * velocity) + operators_.imposed_linear * velocity +
                   operators_.imposed_stiffness * holder);
  return force;
}

Eigen::MatrixXd Resolvent::head_force(int coefficients) const {
  Eigen::MatrixXd force = Eigen::MatrixXd::Zero(operators_.mass.rows(), coefficients);
  force.col(0) = operators_.head;
  return force;
}

} // namespace undula::rom
