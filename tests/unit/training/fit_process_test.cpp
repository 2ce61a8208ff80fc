// Whether fitted processes predict, and know how well they do.
#include "training/emulation/fit_process.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

namespace undula::training {
namespace {

Eigen::MatrixXd spread_points(int inputs, int count, int first = 0) {
  const double steps[] = {0.8191725134, 0.6710436067, 0.5497004779}; // Kronecker sequence of Roberts
  Eigen::MatrixXd points(inputs, count);
  for (int k = 0; k < count; ++k)
    for (int i = 0; i < inputs; ++i) points(i, k) = std::fmod(0.5 + steps[i] * (first + k), 1.0);
  return points;
}

/// Smooth, with a bend in one direction and none in another.
double smooth(const Eigen::VectorXd& x) {
  return 4 + 3 * x[0] - 6 * x[1] + 2 * std::exp(-8 * (x[1] - 0.4) * (x[1] - 0.4)) * std::sin(3 * x[0]);
}

TEST(FitProcess, InterpolatesASmoothFunctionBetterWithMorePoints) {
  double before = 1e9;
  for (const int count : {10, 20, 40, 80}) {
    const auto points = spread_points(3, count);
    Eigen::VectorXd values(count);
    for (int k = 0; k < count; ++k) values[k] = smooth(points.col(k));
    const auto process = fit_process(points, values, Eigen::VectorXd::Zero(count));
    const auto probes = spread_points(3, 200, 1000);
    double square = 0;
    for (int k = 0; k < 200; ++k) square += std::pow(process(probes.col(k)).mean - smooth(probes.col(k)), 2);
    const double rms = std::sqrt(square / 200);
    std::printf("  %d points: rms error %.4f of a range of 9; lengths %.2f %.2f %.2f\n", count, rms,
                process.parameters().lengths[0], process.parameters().lengths[1],
                process.parameters().lengths[2]);
    EXPECT_LT(rms, before);
    before = rms;
    if (count == 80) {
      EXPECT_GT(process.parameters().lengths[2], 3 * process.parameters().lengths[1]);
    }
  }
  EXPECT_LT(before, 0.02);
}

/// Of 400 noisy samples, that no fit saw, about 90 % lie within 1.64 deviations.
TEST(FitProcess, KnowsItsOwnError) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  int within = 0, all = 0;
  std::vector<double> ratios;
  for (int sample = 0; sample < 8; ++sample) {
    const auto points = spread_points(2, 30, 50 * sample), probes = spread_points(2, 50, 5000 + 50 * sample);
    const double bend = 2 + 0.5 * sample;
    const auto truth = [&](const Eigen::VectorXd& x) { return std::sin(bend * x[0] + x[1]) + x[1] * x[0]; };
    Eigen::VectorXd values(30);
    for (int k = 0; k < 30; ++k) values[k] = truth(points.col(k)) + 0.1 * normal(random);
    const auto process = fit_process(points, values, Eigen::VectorXd::Constant(30, 0.1));
    for (int k = 0; k < 50; ++k) {
      const auto there = process(probes.col(k));
      const double error = std::abs(there.mean - truth(probes.col(k)));
      within += error <= 1.645 * there.deviation;
      ratios.push_back(1.645 * there.deviation / error);
      ++all;
    }
  }
  std::nth_element(ratios.begin(), ratios.begin() + all / 2, ratios.end());
  std::printf("  %.1f %% within 1.64 deviations, bar over error %.2f in the median\n", 100.0 * within / all,
              ratios[static_cast<std::size_t>(all) / 2]);
  EXPECT_GT(within, 0.8 * all);
  EXPECT_LT(within, 0.98 * all);
  EXPECT_LT(ratios[static_cast<std::size_t>(all) / 2], 4);
}

} // namespace
} // namespace undula::training
