// Discrete Fourier form of the BDF2 scheme in its periodic state.
#pragma once

#include <Eigen/Core>
#include <complex>

namespace undula::rom {

/// Real Fourier coefficients of a signal of period T known at the n_t steps of the scheme. A row of
/// coefficients is [c_0, Re c_1, Im c_1, Re c_2, ...] and stands for c_0 + sum_k Re(c_k exp(2 pi i k t / T)).
/// With all harmonics (n_t / 2) and n_t points this is an exact, invertible form of the n_t values (a real c
/// at the Nyquist frequency if n_t is even); with fewer it is the projection, and products of two signals are
/// free of aliasing.
class Harmonics {
public:
  /// `harmonics` is lowered to n_t / 2. Points in time for products: n_t if all harmonics are kept, else the
  /// fewest (at most n_t) that keep products free of aliasing.
  Harmonics(int steps_per_period, int harmonics);

  int steps_per_period() const { return steps_; }
  int harmonics() const { return harmonics_; }
  int coefficients() const { return coefficients_; } ///< columns of a coefficient matrix
  int points() const { return points_; }
  bool complete() const { return coefficients_ == steps_; }

  /// Symbol of dt * d/dt under BDF2 at harmonic k: 3/2 - 2/z + 1/(2 z^2), z = exp(2 pi i k / n_t).
  std::complex<double> difference(int k) const;

  /// coefficients x points: values = coefficients * synthesis().
  const Eigen::MatrixXd& synthesis() const { return synthesis_; }
  /// The same, of the extrapolation 2 u^{n-1} - u^{n-2} of the scheme.
  const Eigen::MatrixXd& extrapolated_synthesis() const { return extrapolated_; }
  /// points x coefficients: coefficients = values * analysis().
  const Eigen::MatrixXd& analysis() const { return analysis_; }

  /// coefficients x n_t: values at the steps t = 0, dt, ... of the scheme.
  static Eigen::MatrixXd synthesis_at_steps(int steps_per_period, int coefficients);

private:
  int steps_, harmonics_, coefficients_, points_;
  Eigen::MatrixXd synthesis_, extrapolated_, analysis_;
};

} // namespace undula::rom
