// Least squares within bounds, and what the Jacobian says of the parameters.
#include "training/calibration/bounded_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "rom/base/error.hpp"
#include "training/calibration/identifiability.hpp"
#include "training/training.hpp"

namespace undula::training {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// A model with curvature: a exp(-b t) at five instants, measured for a = 3, b = 0.7.
VectorXd decay(const VectorXd& p) {
  VectorXd flow(5);
  for (int i = 0; i < 5; ++i) flow[i] = p[0] * std::exp(-p[1] * i / 2.0);
  return flow;
}
const Vector2d truth(3, 0.7);

TEST(BoundedFit, FindsTheParametersOfANonlinearModel) {
  const Residuals residuals = [](const VectorXd& p) {
    return std::optional(VectorXd(decay(p) - decay(truth)));
  };
  const BoundedFit fit = fit_within_bounds(residuals, Vector2d(1, 0.1), Vector2d(5, 2), Vector2d(1.5, 1.5));
  EXPECT_TRUE(fit.converged);
  EXPECT_NEAR(fit.point[0], 3, 0.02); // two least steps of the range, 4
  EXPECT_NEAR(fit.point[1], 0.7, 0.01);
  EXPECT_EQ(fit.refused, 0);
  EXPECT_LT(fit.points, 60);
  for (int i = 0; i < 5; ++i) { // against the derivatives by hand
    EXPECT_NEAR(fit.jacobian(i, 0), std::exp(-0.35 * i), 0.01);
    EXPECT_NEAR(fit.jacobian(i, 1), -1.5 * i * std::exp(-0.35 * i), 0.03);
  }
}

TEST(BoundedFit, OneDirectionAloneIsFitted) {
  const Residuals residuals = [](const VectorXd& p) {
    return std::optional(VectorXd(decay(Vector2d(3, p[0])) - decay(truth)));
  };
  const BoundedFit fit = fit_within_bounds(residuals, VectorXd::Constant(1, 0.1), VectorXd::Constant(1, 2),
                                           VectorXd::Constant(1, 1.9));
  EXPECT_TRUE(fit.converged);
  EXPECT_NEAR(fit.point[0], 0.7, 0.01);
}

TEST(BoundedFit, NoiseOfTheModelDoesNotMisleadIt) {
  const Residuals residuals = [](const VectorXd& p) {
    VectorXd r = decay(p) - decay(truth);
    for (int i = 0; i < 5; ++i) r[i] += 1e-3 * std::sin(1e5 * (p[0] + 3 * p[1]) + i); // of the flows: 3
    return std::optional(r);
  };
  const BoundedFit fit = fit_within_bounds(residuals, Vector2d(1, 0.1), Vector2d(5, 2), Vector2d(1.5, 1.5));
  EXPECT_NEAR(fit.point[0], 3, 0.03);
  EXPECT_NEAR(fit.point[1], 0.7, 0.02);
  EXPECT_NEAR(fit.jacobian(0, 0), 1, 0.02);
}

TEST(BoundedFit, StaysWithinBoundsAndEndsOnTheNearest) {
  const Residuals residuals = [](const VectorXd& p) {
    EXPECT_GE(p[0], 1);
    EXPECT_LE(p[0], 2.5);
    return std::optional(VectorXd(decay(p) - decay(truth)));
  };
  const BoundedFit fit = fit_within_bounds(residuals, Vector2d(1, 0.1), Vector2d(2.5, 2), Vector2d(1, 2));
  EXPECT_NEAR(fit.point[0], 2.5, 0.005);
  EXPECT_NEAR(fit.jacobian(0, 0), 1, 1e-6); // from the inside alone
}

TEST(BoundedFit, WhatCannotBeComputedIsRefusedAndNeverTheAnswer) {
  // A wall beside the optimum: nothing can be computed for b < 0.68.
  int missing = 0;
  const Residuals residuals = [&](const VectorXd& p) -> std::optional<VectorXd> {
    if (p[1] < 0.68) {
      ++missing;
      return std::nullopt;
    }
    return VectorXd(decay(p) - decay(truth));
  };
  const BoundedFit fit = fit_within_bounds(residuals, Vector2d(1, 0.1), Vector2d(5, 2), Vector2d(1.5, 0.8));
  EXPECT_GT(missing, 0);
  EXPECT_EQ(fit.refused, missing);
  EXPECT_GE(fit.point[1], 0.68);
  EXPECT_NEAR(fit.point[0], 3, 0.1);
  EXPECT_NEAR(fit.point[1], 0.7, 0.05);
  EXPECT_TRUE(fit.jacobian.allFinite());

  const Residuals never = [](const VectorXd&) { return std::optional<VectorXd>(); };
  EXPECT_THROW(fit_within_bounds(never, Vector2d(1, 0.1), Vector2d(5, 2), Vector2d(1.5, 0.8)), NumericsError);
}

TEST(BoundedFit, ExceptionsOfTheModelComeThrough) {
  int points = 0;
  const Residuals residuals = [&](const VectorXd& p) {
    if (++points == 4) throw InputError("a", "b", "c", "d");
    return std::optional(VectorXd(decay(p)));
  };
  EXPECT_THROW(fit_within_bounds(residuals, Vector2d(1, 0.1), Vector2d(5, 2), Vector2d(1.5, 0.8)),
               InputError);
  EXPECT_EQ(points, 4);
}

TEST(Identifiability, OfALineItIsTheTextbook) {
  // y = a + b t at t = 0..3, deviation 0.1: sd(a) = 0.1 sqrt(1/4 + 1.5^2/5), sd(b) = 0.1 / sqrt(5),
  // correlation -1.5 / sqrt(1.5^2 + 5/4).
  MatrixXd jacobian(4, 2);
  jacobian << 1, 0, 1, 1, 1, 2, 1, 3;
  const Vector2d range(2, 8);
  const auto result = identifiability(jacobian, range, VectorXd::Constant(4, 0.1), 1e-3);
  EXPECT_NEAR(result.standard_error[0], 0.1 * std::sqrt(0.25 + 2.25 / 5), 1e-12);
  EXPECT_NEAR(result.standard_error[1], 0.1 / std::sqrt(5.0), 1e-12);
  EXPECT_NEAR(result.correlation(0, 1), -1.5 / std::sqrt(2.25 + 1.25), 1e-12);
  EXPECT_NEAR(result.influence[0], 2, 1e-12);
  EXPECT_NEAR(result.singular_values.norm(), (jacobian * range.asDiagonal()).norm(), 1e-12);
  EXPECT_NEAR(result.condition, result.singular_values[0] / result.singular_values[1], 1e-12);
  EXPECT_TRUE(result.correlated.empty());
  EXPECT_TRUE(result.unfixed_directions.empty());
  EXPECT_TRUE(result.without_influence.empty());
}

TEST(Identifiability, NamesWhatTheDataDoNotFix) {
  // The second parameter nearly repeats the first, the third does nothing.
  MatrixXd jacobian(4, 3);
  jacobian << 1, 1.01, 0, 1, 0.99, 0, 1, 1.01, 0, 1, 0.99, 0;
  const auto result = identifiability(jacobian, Eigen::Vector3d::Ones(), VectorXd::Constant(4, 0.1), 1e-3);
  EXPECT_EQ(result.without_influence, (std::vector<int>{2}));
  ASSERT_EQ(result.correlated.size(), 1u);
  EXPECT_EQ(result.correlated[0], (std::array<int, 2>{0, 1}));
  EXPECT_LT(result.correlation(0, 1), -strong_correlation);
  ASSERT_EQ(result.unfixed_directions.size(), 2u); // the difference of the two, and the third
  EXPECT_NEAR(std::abs(result.directions(2, 2)), 1, 1e-12);
  EXPECT_NEAR(result.directions(0, 1), -result.directions(1, 1), 0.02);
  EXPECT_TRUE(std::isinf(result.standard_error[2]));
  EXPECT_TRUE(std::isnan(result.correlation(2, 2)));
  EXPECT_TRUE(std::isfinite(result.standard_error[0]));
}

TEST(Identifiability, FewerResidualsThanParametersFixNotAll) {
  MatrixXd jacobian(1, 2);
  jacobian << 1, 2;
  const auto result = identifiability(jacobian, Vector2d::Ones(), VectorXd::Constant(1, 0.1), 1e-3);
  EXPECT_EQ(result.unfixed_directions, (std::vector<int>{1}));
  EXPECT_TRUE(std::isinf(result.standard_error[0]));
  EXPECT_TRUE(std::isinf(result.condition));
}

} // namespace
} // namespace undula::training
