// Sensitivities against functions whose indices are known in closed form.
#include "training/study/sensitivity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "training/sampling/scrambled_halton.hpp"

namespace undula::training {
namespace {

/// Rows of a space-filling plan in [-1, 1].
Eigen::MatrixXd spread(int runs, int keys) {
  const ScrambledHalton halton(7, keys);
  Eigen::MatrixXd x(runs, keys);
  for (int k = 0; k < runs; ++k) {
    const auto point = halton(k + 1);
    for (int i = 0; i < keys; ++i) x(k, i) = 2 * point[static_cast<std::size_t>(i)] - 1;
  }
  return x;
}

template <typename Function>
Eigen::VectorXd values(const Eigen::MatrixXd& x, const Function& function) {
  Eigen::VectorXd y(x.rows());
  for (Eigen::Index run = 0; run < x.rows(); ++run) y[run] = function(x.row(run));
  return y;
}

const std::vector<std::string> three = {"a", "b", "c"};

TEST(Sensitivities, OfAQuadraticFunctionAreExact) {
  // Variances over [-1, 1]^3: 4 a: 16/3; 3 b^2: 9 (1/5 - 1/9) = 4/5; 6 a c: 36/9 = 4.
  const auto x = spread(40, 3);
  const auto found = sensitivities(
      three, x, values(x, [](const auto& p) { return 10 + 4 * p[0] + 3 * p[1] * p[1] + 6 * p[0] * p[2]; }));
  const double all = 16.0 / 3 + 0.8 + 4;
  ASSERT_EQ(found.keys.size(), 3u);
  EXPECT_NEAR(found.keys[0].first_order, 16.0 / 3 / all, 1e-12);
  EXPECT_NEAR(found.keys[1].first_order, 0.8 / all, 1e-12);
  EXPECT_NEAR(found.keys[2].first_order, 0, 1e-12);
  EXPECT_NEAR(found.keys[0].total, (16.0 / 3 + 4) / all, 1e-12);
  EXPECT_NEAR(found.keys[1].total, 0.8 / all, 1e-12);
  EXPECT_NEAR(found.keys[2].total, 4 / all, 1e-12);
  EXPECT_NEAR(found.left_out, 1, 1e-12);
  EXPECT_NEAR(found.mean, 11, 1e-12);
  EXPECT_NEAR(found.keys[0].slope, 4, 1e-12);
  EXPECT_NEAR(found.keys[1].bend, 2, 1e-12); // 3 b^2 = 1 + 2 (3 b^2 - 1) / 2
}

TEST(Sensitivities, OfAFullPlanAreThoseOfTheBoxAndNotOfItsCorners) {
  Eigen::MatrixXd x(25, 2);
  for (int i = 0; i < 25; ++i) x.row(i) << -1 + 0.5 * (i / 5), -1 + 0.5 * (i % 5);
  const auto found =
      sensitivities({"a", "b"}, x, values(x, [](const auto& p) { return p[0] * p[0] + 0.5 * p[1]; }));
  const double all = 4.0 / 45 + 0.25 / 3;
  EXPECT_NEAR(found.keys[0].first_order, 4.0 / 45 / all, 1e-12);
  EXPECT_NEAR(found.keys[1].first_order, 0.25 / 3 / all, 1e-12);
}

TEST(Sensitivities, TheLinearLawOfALinearFunctionExplainsAll) {
  const auto x = spread(30, 3);
  const auto y = values(x, [](const auto& p) { return 3 * p[0] - 4 * p[1]; });
  const auto found = sensitivities(three, x, y);
  EXPECT_NEAR(found.linear, 1, 1e-12);
  const auto deviation = [](const Eigen::VectorXd& v) {
    return std::sqrt((v.array() - v.mean()).square().mean());
  };
  EXPECT_NEAR(found.keys[0].standardised, 3 * deviation(x.col(0)) / deviation(y), 1e-12);
  EXPECT_NEAR(found.keys[1].standardised, -4 * deviation(x.col(1)) / deviation(y), 1e-12);
  EXPECT_NEAR(found.keys[2].standardised, 0, 1e-12);
}

TEST(Sensitivities, OfWhatIsNoQuadraticFunctionSayThatTheyAreNot) {
  // Ishigami and Homma: sin x1 + 7 sin^2 x2 + 0.1 x3^4 sin x1 over [-pi, pi]^3.
  const auto x = spread(200, 3);
  const auto found = sensitivities(
      three, x, values(x, [](const auto& p) {
        const double a = std::numbers::pi * p[0], b = std::numbers::pi * p[1], c = std::numbers::pi * p[2];
        return std::sin(a) + 7 * std::pow(std::sin(b), 2) + 0.1 * std::pow(c, 4) * std::sin(a);
      }));
  EXPECT_LT(found.left_out, 0.6);
}

TEST(Sensitivities, NeedRunsEnough) {
  const auto linear = [](const auto& p) { return p[0] + 2 * p[1]; };
  const auto few = spread(19, 3); // ten terms
  const auto found = sensitivities(three, few, values(few, linear));
  EXPECT_TRUE(std::isnan(found.left_out));
  EXPECT_TRUE(std::isnan(found.keys[0].first_order));
  EXPECT_NEAR(found.linear, 1, 1e-12);
  const auto too_few = spread(4, 3);
  EXPECT_TRUE(sensitivities(three, too_few, values(too_few, linear)).keys.empty());
  const auto enough = spread(20, 3);
  EXPECT_TRUE(sensitivities(three, enough, values(enough, [](const auto&) { return 0.1; })).keys.empty());
}

TEST(Sensitivities, KeysOfTwoValuesHaveNoSquares) {
  Eigen::MatrixXd x(12, 2);
  for (int i = 0; i < 12; ++i) x.row(i) << (i % 2 == 0 ? -1 : 1), -1 + 0.4 * (i / 2);
  const auto found =
      sensitivities({"a", "b"}, x, values(x, [](const auto& p) { return p[0] + p[1] * p[1]; }));
  EXPECT_NEAR(found.left_out, 1, 1e-12);
  EXPECT_EQ(found.keys[0].bend, 0);
}

} // namespace
} // namespace undula::training
