// Answer of the linear part of the reduced model to forces of one frequency and its harmonics.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <vector>

#include "rom/fixed_domain/harmonics.hpp"
#include "rom/fixed_domain/model.hpp"

namespace undula::rom {

/// For harmonic k with rate s_k = difference(k) / dt, the linear operator on y is L_k = s_k M + K + S / s_k
/// (S on the displacement rows and columns). At k = 0 the velocity of the membrane vanishes and its
/// displacement a_d takes the place of a_v in y: L_0 = K with the columns of v replaced by [0; 0; S].
/// Factored once per frequency for harmonics 0 .. harmonics(); grows on demand.
class Resolvent {
public:
  Resolvent(const Operators& operators, double frequency_Hz, int steps_per_period);

  /// Makes harmonics 0 .. `harmonics` available. Throws NumericsError if an L_k is singular.
  void extend(int harmonics);
  int harmonics() const { return static_cast<int>(factors_.size()) - 1; }

  /// Answer y (N x coefficients) to a force on all rows (N x coefficients): solves L_k y_k = force_k.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& force) const;

  /// Velocity rows of solve() for forces on the velocity rows only: nu x coefficients, both.
  Eigen::MatrixXd velocity_response(const Eigen::MatrixXd& force) const;

  /// Displacement coefficients (nv x coefficients) that belong to an answer y.
  Eigen::MatrixXd displacement(const Eigen::MatrixXd& y) const;

  /// Forces (N x coefficients) of a holder displacement sin(2 pi f t) of 1 cm, and of a head of 1 dyn/cm^2,
  /// to be negated when brought to the right-hand side.
  Eigen::MatrixXd holder_force(int coefficients) const;
  Eigen::MatrixXd head_force(int coefficients) const;

private:
  std::complex<double> rate(int k) const { return symbols_.difference(k) / dt_; }

  const Operators& operators_;
  Harmonics symbols_;
  double dt_;
  std::vector<Eigen::PartialPivLU<Eigen::MatrixXcd>> factors_; ///< of L_k
  std::vector<Eigen::MatrixXcd> velocity_blocks_;              ///< velocity rows and columns of L_k^{-1}
};

} // namespace undula::rom
