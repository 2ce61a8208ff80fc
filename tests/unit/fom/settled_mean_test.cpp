// The mean of a fluctuating signal and its standard error, where the truth is known.
#include "fom/output/settled_mean.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

namespace undula::fom {
namespace {

/// Values about 2 with standard deviation 0.1 and correlation r of neighbours, after a transient of 3.
std::vector<double> signal(std::mt19937& generator, int count, double r, double transient) {
  std::normal_distribution<double> normal;
  std::vector<double> values;
  double deviation = 0.1 * normal(generator);
  for (int i = 0; i < count; ++i) {
    values.push_back(2 + deviation + transient * std::exp(-i / 1.5));
    deviation = r * deviation + 0.1 * std::sqrt(1 - r * r) * normal(generator);
  }
  return values;
}

TEST(SettledMean, StatesItsError) {
  for (const double r : {0.0, 0.6}) {
    for (const int count : {12, 60}) {
      std::mt19937 generator(7);
      constexpr int trials = 400;
      int within = 0;
      double error = 0, stated = 0;
      for (int trial = 0; trial < trials; ++trial) {
        const auto found = settled_mean(signal(generator, count, r, 3));
        within += std::abs(found.mean - 2) <= 2 * found.standard_error;
        error += std::pow(found.mean - 2, 2) / trials;
        stated += std::pow(found.standard_error, 2) / trials;
      }
      std::printf("%d values, correlation %.1f: error %.4f, stated %.4f; within two of them %.0f %%\n", count,
                  r, std::sqrt(error), std::sqrt(stated), 100.0 * within / trials);
      // Few values know little of their own correlation: 70 % instead of 95 for 12 with a correlation of 0.6.
      EXPECT_GT(within, (count > 20 ? 0.85 : 0.65) * trials);
      EXPECT_LT(within, 0.99 * trials);
      EXPECT_NEAR(stated / error, 1, 0.6);
    }
  }
}

TEST(SettledMean, LeavesTheTransientOut) {
  const std::vector<double> values = {-3, 0, 1.5, 1.9, 2.05, 1.95, 2.0, 2.05, 1.95, 2.0};
  const auto found = settled_mean(values);
  EXPECT_GE(found.counted, 5);
  EXPECT_LE(found.counted, 7);
  EXPECT_NEAR(found.mean, 2, 0.03);
  EXPECT_LE(found.spread, 0.15 + 1e-12);
}

TEST(SettledMean, KnowsNoErrorOfTwoValues) {
  const std::vector<double> two = {1, 2}, one = {5}, same = {3, 3, 3, 3};
  EXPECT_EQ(settled_mean(two).mean, 2);
  EXPECT_EQ(settled_mean(two).counted, 1);
  EXPECT_TRUE(std::isnan(settled_mean(two).standard_error));
  EXPECT_EQ(settled_mean(one).mean, 5);
  EXPECT_EQ(settled_mean({}).counted, 0);
  EXPECT_EQ(settled_mean(same).standard_error, 0);
  EXPECT_EQ(settled_mean(same).counted, 4);
}

} // namespace
} // namespace undula::fom
