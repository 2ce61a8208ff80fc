// Regression by a Gaussian process with a linear trend: values between points, and how far they may be off.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace undula::rom {

/// What is assumed of a function of d inputs, each scaled to the unit interval: a linear trend, whose
/// coefficients are unknown, and a process of mean 0 about it with the covariance
///   variance * (1 + r + r^2/3) exp(-r),  r = sqrt(5) |(x - y) / lengths|     (Matern, smoothness 5/2).
/// A value that was observed is off by its own error and by what `nugget` stands for: changes that
/// neighbouring points do not share.
struct ProcessParameters {
  Eigen::VectorXd lengths; ///< d, parts of the unit interval
  double variance = 0;     ///< square of the values' unit
  double nugget = 0;       ///< the same
};

struct Prediction {
  double mean = 0;
  double deviation = 0; ///< standard deviation of the function there, without nugget
};

/// The process under the condition of n values.
class GaussianProcess {
public:
  /// `points` d x n; `values` n; `noise` n, standard errors of the values. Throws InputError for sizes that
  /// do not fit, numbers that are not finite, lengths or a variance that are not positive, or fewer than d +
  /// 2 points; NumericsError where the points are too many for the trend's rank or coincide without noise.
  GaussianProcess(Eigen::MatrixXd points, Eigen::VectorXd values, Eigen::VectorXd noise,
                  ProcessParameters parameters);

  /// Value at `x`, d inputs.
  Prediction operator()(const Eigen::VectorXd& x) const;

  /// Every value as predicted from all others (columns: mean, deviation of the observation), with the same
  /// parameters. Closed form of Dubrule (1983).
  Eigen::MatrixX2d leave_one_out() const;

  /// Logarithm of the likelihood of the values whatever the trend (restricted likelihood), up to a constant.
  double log_likelihood() const;

  const Eigen::MatrixXd& points() const { return points_; }
  const Eigen::VectorXd& values() const { return values_; }
  const Eigen::VectorXd& noise() const { return noise_; }
  const ProcessParameters& parameters() const { return parameters_; }

private:
  Eigen::VectorXd covariance_with(const Eigen::VectorXd& x) const;

  Eigen::MatrixXd points_;
  Eigen::VectorXd values_, noise_;
  ProcessParameters parameters_;
  Eigen::LLT<Eigen::MatrixXd> covariance_;  ///< n x n, with noise
  Eigen::MatrixXd whitened_trend_;          ///< n x (d + 1): L^-1 H
  Eigen::LLT<Eigen::MatrixXd> information_; ///< of the trend's coefficients: H^T K^-1 H
  Eigen::VectorXd trend_;                   ///< d + 1 coefficients, the constant first
  Eigen::VectorXd weights_;                 ///< n: K^-1 (values - H trend)
};

} // namespace undula::rom
