#include "rom/emulator/gaussian_process.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "rom/base/error.hpp"

namespace undula::rom {
namespace {

double matern(double scaled_square) {
  const double r = std::sqrt(5 * scaled_square);
  return (1 + r + r * r / 3) * std::exp(-r);
}

Eigen::VectorXd trend_at(const Eigen::VectorXd& x) {
  Eigen::VectorXd row(x.size() + 1);
  row << 1.0, x;
  return row;
}

void refuse(bool wrong, const char* what, const std::string& seen, const char* allowed) {
  if (wrong) throw InputError(what, seen, allowed, "GaussianProcess");
}

} // namespace

GaussianProcess::GaussianProcess(Eigen::MatrixXd points, Eigen::VectorXd values, Eigen::VectorXd noise,
                                 ProcessParameters parameters)
    : points_(std::move(points)),
      values_(std::move(values)),
      noise_(std::move(noise)),
      parameters_(std::move(parameters)) {
  const Eigen::Index inputs = points_.rows(), count = points_.cols();
  refuse(values_.size() != count || noise_.size() != count,
         "an emulator needs a value and its error at every point",
         std::to_string(values_.size()) + " values, " + std::to_string(noise_.size()) + " errors",
         "as many as points");
  refuse(parameters_.lengths.size() != inputs, "an emulator needs a length for every input",
         std::to_string(parameters_.lengths.size()) + " lengths", "as many as inputs");
  refuse(count < inputs + 2, "too few points for a trend and a process about it",
         std::to_string(count) + " points", "inputs + 2 or more");
  refuse(!points_.allFinite() || !values_.allFinite() || !noise_.allFinite() || noise_.minCoeff() < 0,
         "the points of an emulator", "a number that is not finite, or a negative error", "finite numbers");
  refuse(!(parameters_.lengths.minCoeff() > 0) || !(parameters_.variance > 0) || !(parameters_.nugget >= 0),
         "the parameters of an emulator", "a length or variance that is not positive", "positive ones");

  Eigen::MatrixXd covariance(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    covariance.col(i) = covariance_with(points_.col(i));
    covariance(i, i) += noise_[i] * noise_[i] + parameters_.nugget;
  }
  covariance_.compute(covariance);
  const Eigen::MatrixXd root = covariance_.matrixL();
  if (covariance_.info() != Eigen::Success || root.diagonal().minCoeff() < 1e-7 * root.diagonal().maxCoeff())
    throw NumericsError("the points of an emulator do not tell their values apart",
                        std::to_string(count) + " points", "points that differ, or a nugget");
  Eigen::MatrixXd trend(count, inputs + 1);
  for (Eigen::Index i = 0; i < count; ++i) trend.row(i) = trend_at(points_.col(i)).transpose();
  whitened_trend_ = covariance_.matrixL().solve(trend);
  information_.compute(whitened_trend_.transpose() * whitened_trend_);
  const Eigen::MatrixXd trend_root = information_.matrixL();
  if (information_.info() != Eigen::Success ||
      trend_root.diagonal().minCoeff() < 1e-7 * trend_root.diagonal().maxCoeff())
    throw NumericsError("the points of an emulator lie in a plane, so that no trend can be told",
                        std::to_string(count) + " points", "points that spread in every input");
  const Eigen::VectorXd whitened = covariance_.matrixL().solve(values_);
  trend_ = information_.solve(whitened_trend_.transpose() * whitened);
  weights_ = covariance_.matrixU().solve(whitened - whitened_trend_ * trend_);
}

Eigen::VectorXd GaussianProcess::covariance_with(const Eigen::VectorXd& x) const {
  Eigen::VectorXd covariance(points_.cols());
  for (Eigen::Index i = 0; i < points_.cols(); ++i)
    covariance[i] =
        parameters_.variance * matern((points_.col(i) - x).cwiseQuotient(parameters_.lengths).squaredNorm());
  return covariance;
}

Prediction GaussianProcess::operator()(const Eigen::VectorXd& x) const {
  const Eigen::VectorXd covariance = covariance_with(x), trend = trend_at(x);
  const Eigen::VectorXd whitened = covariance_.matrixL().solve(covariance);
  // What the unknown coefficients of the trend add.
  const Eigen::VectorXd unexplained = trend - whitened_trend_.transpose() * whitened;
  const double variance = parameters_.variance - whitened.squaredNorm() +
                          unexplained.dot(Eigen::VectorXd(information_.solve(unexplained)));
  return {trend.dot(trend_) + covariance.dot(weights_), std::sqrt(std::max(variance, 0.0))};
}

Eigen::MatrixX2d GaussianProcess::leave_one_out() const {
  const Eigen::Index count = points_.cols();
  const Eigen::MatrixXd inverse_root = covariance_.matrixL().solve(Eigen::MatrixXd::Identity(count, count));
  // With Q = K^-1 - K^-1 H (H^T K^-1 H)^-1 H^T K^-1 the error at i is (Q y)_i / Q_ii, its variance 1 / Q_ii.
  const Eigen::MatrixXd through = inverse_root.transpose() * whitened_trend_;
  const Eigen::MatrixXd solved = information_.solve(through.transpose());
  Eigen::MatrixX2d result(count, 2);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double own = inverse_root.col(i).squaredNorm() - through.row(i).dot(solved.col(i));
    result(i, 0) = values_[i] - weights_[i] / own;
    result(i, 1) = 1 / std::sqrt(own);
  }
  return result;
}

double GaussianProcess::log_likelihood() const {
  const auto log_determinant = [](const Eigen::LLT<Eigen::MatrixXd>& factors) {
    const Eigen::MatrixXd root = factors.matrixL();
    return 2 * root.diagonal().array().log().sum();
  };
  return -0.5 * (log_determinant(covariance_) + log_determinant(information_) + values_.dot(weights_));
}

} // namespace undula::rom
