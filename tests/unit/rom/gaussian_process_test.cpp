// Regression by a Gaussian process against what follows from its definition.
#include "rom/emulator/gaussian_process.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "rom/base/error.hpp"

namespace undula::rom {
namespace {

/// Points of a Kronecker sequence in the unit square.
Eigen::MatrixXd spread_points(int count) {
  Eigen::MatrixXd points(2, count);
  for (int k = 0; k < count; ++k)
    points.col(k) << std::fmod(0.5 + 0.7548776662 * k, 1.0), std::fmod(0.5 + 0.5698402910 * k, 1.0);
  return points;
}

Eigen::VectorXd values_of(const Eigen::MatrixXd& points) {
  Eigen::VectorXd values(points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    values[i] = 3 + 2 * points(0, i) - points(1, i) + std::sin(4 * points(0, i)) * std::cos(3 * points(1, i));
  return values;
}

const ProcessParameters parameters{Eigen::Vector2d(0.6, 0.9), 0.5, 1e-3};

TEST(GaussianProcess, MeetsExactValuesAndKnowsThem) {
  const auto points = spread_points(20);
  const auto values = values_of(points);
  const GaussianProcess exact(points, values, Eigen::VectorXd::Zero(20), {parameters.lengths, 0.5, 0});
  for (int i = 0; i < 20; ++i) {
    const auto there = exact(points.col(i));
    EXPECT_NEAR(there.mean, values[i], 1e-8);
    EXPECT_LT(there.deviation, 1e-4);
  }
  EXPECT_GT(exact(Eigen::Vector2d(3, 3)).deviation, 0.5); // far from all
}

TEST(GaussianProcess, ContinuesALinearTrendFarOutside) {
  const auto points = spread_points(8);
  Eigen::VectorXd values(8);
  for (int i = 0; i < 8; ++i) values[i] = 1 + 2 * points(0, i) - 5 * points(1, i);
  const GaussianProcess process(points, values, Eigen::VectorXd::Zero(8), parameters);
  EXPECT_NEAR(process(Eigen::Vector2d(40, -30)).mean, 1 + 80 + 150, 1e-6);
}

/// Mean and deviation by the formulas of universal kriging with full inverses.
TEST(GaussianProcess, IsUniversalKriging) {
  const auto points = spread_points(12);
  const auto values = values_of(points);
  const Eigen::VectorXd noise = Eigen::VectorXd::LinSpaced(12, 0, 0.2);
  const GaussianProcess process(points, values, noise, parameters);
  const auto covariance = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const double r = std::sqrt(5.0) * (a - b).cwiseQuotient(Eigen::Vector2d(0.6, 0.9)).norm();
    return 0.5 * (1 + r + r * r / 3) * std::exp(-r);
  };
  Eigen::MatrixXd full(12, 12), trend(12, 3);
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 12; ++j) full(i, j) = covariance(points.col(i), points.col(j));
    full(i, i) += noise[i] * noise[i] + 1e-3;
    trend.row(i) << 1, points(0, i), points(1, i);
  }
  // The saddle point of the best linear unbiased prediction.
  Eigen::MatrixXd saddle = Eigen::MatrixXd::Zero(15, 15);
  saddle.topLeftCorner(12, 12) = full;
  saddle.topRightCorner(12, 3) = trend;
  saddle.bottomLeftCorner(3, 12) = trend.transpose();
  for (const Eigen::Vector2d& x : {Eigen::Vector2d(0.3, 0.8), Eigen::Vector2d(1.4, -0.2)}) {
    Eigen::VectorXd right(15);
    for (int i = 0; i < 12; ++i) right[i] = covariance(points.col(i), x);
    right.tail(3) << 1, x[0], x[1];
    const Eigen::VectorXd solution = saddle.fullPivLu().solve(right);
    const auto there = process(x);
    EXPECT_NEAR(there.mean, solution.head(12).dot(values), 1e-10);
    EXPECT_NEAR(there.deviation * there.deviation, 0.5 - solution.dot(right), 1e-10);
  }
}

TEST(GaussianProcess, LeavesOneOutAsIfItHadNeverBeenThere) {
  const auto points = spread_points(15);
  const auto values = values_of(points);
  const Eigen::VectorXd noise = Eigen::VectorXd::Constant(15, 0.05);
  const GaussianProcess process(points, values, noise, parameters);
  const auto closed = process.leave_one_out();
  for (int out = 0; out < 15; ++out) {
    Eigen::MatrixXd others(2, 14);
    Eigen::VectorXd rest(14);
    for (int i = 0, k = 0; i < 15; ++i)
      if (i != out) {
        others.col(k) = points.col(i);
        rest[k++] = values[i];
      }
    const GaussianProcess without(others, rest, noise.head(14), parameters);
    const auto there = without(points.col(out));
    EXPECT_NEAR(closed(out, 0), there.mean, 1e-9);
    EXPECT_NEAR(closed(out, 1), std::sqrt(there.deviation * there.deviation + 0.05 * 0.05 + 1e-3), 1e-9);
  }
}

TEST(GaussianProcess, RefusesWhatDoesNotFit) {
  const auto points = spread_points(6);
  const Eigen::VectorXd values = Eigen::VectorXd::Ones(6), noise = Eigen::VectorXd::Zero(6);
  EXPECT_THROW(GaussianProcess(points, values.head(5), noise, parameters), InputError);
  EXPECT_THROW(GaussianProcess(points, values, noise, {Eigen::Vector3d::Ones(), 1, 0}), InputError);
  EXPECT_THROW(GaussianProcess(points, values, noise, {Eigen::Vector2d(1, 0), 1, 0}), InputError);
  EXPECT_THROW(GaussianProcess(points, values, -Eigen::VectorXd::Ones(6), parameters), InputError);
  EXPECT_THROW(GaussianProcess(points.leftCols(3), values.head(3), noise.head(3), parameters), InputError);
  Eigen::VectorXd broken = values;
  broken[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(GaussianProcess(points, broken, noise, parameters), InputError);
  const Eigen::MatrixXd same = points.col(0).replicate(1, 6);
  EXPECT_THROW(GaussianProcess(same, values, noise, {parameters.lengths, 1, 0}), NumericsError);
  Eigen::MatrixXd flat = points;
  flat.row(1) = flat.row(0);
  EXPECT_THROW(GaussianProcess(flat, values, noise, parameters), NumericsError);
}

} // namespace
} // namespace undula::rom
