#include "training/sampling/plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>

#include "rom/base/error.hpp"
#include "training/training.hpp"

namespace undula::training {
namespace {

TrainingPlan pump_box(int training, int held_out) {
  TrainingPlan box;
  box.frequency_low = 80, box.frequency_high = 140;
  box.stroke_low = 0.01, box.stroke_high = 0.08;
  box.head_low = 0, box.head_high = 93325.67;
  box.training_points = training, box.held_out_points = held_out;
  return box;
}

std::array<double, 3> scaled(const TrainingPlan& box, const OperatingPoint& p) {
  const auto scale = [](double low, double high, double x) {
    return high > low ? (x - low) / (high - low) : 0;
  };
  return {scale(box.frequency_low, box.frequency_high, p.frequency),
          scale(box.stroke_low, box.stroke_high, p.stroke), scale(box.head_low, box.head_high, p.head)};
}

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Star discrepancy sampled on an m^3 grid of anchored boxes (a lower bound, tight to 3/m).
double star_discrepancy(const std::vector<std::array<double, 3>>& points) {
  const int m = 20;
  double worst = 0;
  for (int i = 1; i <= m; ++i)
    for (int j = 1; j <= m; ++j)
      for (int k = 1; k <= m; ++k) {
        const auto inside = std::count_if(points.begin(), points.end(), [&](const auto& p) {
          return p[0] * m < i && p[1] * m < j && p[2] * m < k;
        });
        worst =
            std::max(worst, std::abs(double(inside) / double(points.size()) - i * j * k / double(m * m * m)));
      }
  return worst;
}

TEST(Plan, StartsWithTheExactCorners) {
  const auto box = pump_box(12, 8);
  const auto plan = plan_samples(box);
  ASSERT_EQ(plan.training.size(), 20u);
  ASSERT_EQ(plan.held_out.size(), 8u);
  std::set<std::tuple<double, double, double>> corners;
  for (int k = 0; k < 8; ++k) {
    const auto& p = plan.training[k];
    EXPECT_TRUE(p.frequency == 80 || p.frequency == 140);
    EXPECT_TRUE(p.stroke == 0.01 || p.stroke == 0.08);
    EXPECT_TRUE(p.head == 0 || p.head == 93325.67);
    corners.insert({p.frequency, p.stroke, p.head});
  }
  EXPECT_EQ(corners.size(), 8u);
}

TEST(Plan, InteriorPointsLieInsideTheBox) {
  const auto box = pump_box(60, 12);
  const auto plan = plan_samples(box);
  for (std::size_t k = 8; k < plan.training.size(); ++k)
    for (const double x : scaled(box, plan.training[k])) {
      EXPECT_GT(x, 0);
      EXPECT_LT(x, 1);
    }
  for (const auto& p : plan.held_out)
    for (const double x : scaled(box, p)) {
      EXPECT_GE(x, 0.1);
      EXPECT_LE(x, 0.9);
    }
}

TEST(Plan, HeldOutPointsKeepTheirDistance) {
  for (const auto& [training, held_out] : {std::pair{0, 8}, {12, 8}, {24, 10}, {100, 30}}) {
    const auto box = pump_box(training, held_out);
    const auto plan = plan_samples(box);
    const double n = static_cast<double>(plan.training.size() + plan.held_out.size());
    const double least = 0.3 * std::cbrt(1 / n);
    for (std::size_t i = 0; i < plan.held_out.size(); ++i) {
      for (const auto& p : plan.training)
        EXPECT_GE(distance(scaled(box, plan.held_out[i]), scaled(box, p)), least) << training;
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_GE(distance(scaled(box, plan.held_out[i]), scaled(box, plan.held_out[j])), least) << training;
    }
  }
}

TEST(Plan, TrainingPointsFillTheBox) {
  const auto box = pump_box(64, 0);
  const auto plan = plan_samples(box);
  std::vector<std::array<double, 3>> interior;
  for (std::size_t k = 8; k < plan.training.size(); ++k) interior.push_back(scaled(box, plan.training[k]));
  // 64 random points have 0.16 on average; a regular 4^3 grid has 0.33.
  EXPECT_LT(star_discrepancy(interior), 0.11);
  double nearest = 1;
  for (std::size_t i = 0; i < interior.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) nearest = std::min(nearest, distance(interior[i], interior[j]));
  EXPECT_GT(nearest, 0.04);
}

TEST(Plan, IsTheSameEveryTimeAndGrowsByAppending) {
  const auto small = plan_samples(pump_box(10, 4));
  const auto again = plan_samples(pump_box(10, 4));
  const auto large = plan_samples(pump_box(30, 4));
  for (std::size_t k = 0; k < small.training.size(); ++k) {
    EXPECT_EQ(small.training[k].stroke, again.training[k].stroke);
    EXPECT_EQ(small.training[k].frequency, large.training[k].frequency);
    EXPECT_EQ(small.training[k].stroke, large.training[k].stroke);
    EXPECT_EQ(small.training[k].head, large.training[k].head);
  }
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(small.held_out[k].head, again.held_out[k].head);
}

TEST(Plan, FixedRangesAreNotSampled) {
  auto box = pump_box(5, 3);
  box.frequency_high = box.frequency_low;
  box.stroke_high = box.stroke_low;
  const auto plan = plan_samples(box);
  EXPECT_EQ(plan.training.size(), 2u + 5u);
  std::set<double> heads;
  for (const auto& points : {plan.training, plan.held_out})
    for (const auto& p : points) {
      EXPECT_EQ(p.frequency, 80);
      EXPECT_EQ(p.stroke, 0.01);
      heads.insert(p.head);
    }
  EXPECT_EQ(heads.size(), 10u);
  std::vector<double> sorted(heads.begin(), heads.end());
  for (const auto& held : plan.held_out)
    for (const double head : sorted) {
      if (head == held.head) continue;
      EXPECT_GE(std::abs(head - held.head), 0.3 / 10 * box.head_high);
    }
}

TEST(Plan, VariedKeysAreRangesOfTheirOwnBesideTheSameOperatingPoints) {
  const auto box = pump_box(12, 4);
  const std::vector<VariedKey> varied = {{"membrane.young_dyn_per_cm2", "dyn_per_cm2", 1e7, 3e7, 1.5e7},
                                         {"membrane.damping_time_s", "s", 1e-4, 2e-4, 2e-4}};
  const auto plain = plan_samples(box), plan = plan_samples(box, {}, varied);
  ASSERT_EQ(plan.training.size(), 20u);
  std::set<double> moduli;
  for (std::size_t k = 0; k < plan.training.size(); ++k) {
    const auto& point = plan.training[k];
    EXPECT_EQ(scaled(box, point), scaled(box, plain.training[k]));
    EXPECT_TRUE(is_inside(box, point, varied));
    if (k < 8) {
      EXPECT_TRUE(point.varied.empty()); // corners: records of a campaign that varies nothing
      continue;
    }
    ASSERT_EQ(point.varied.size(), 2u);
    moduli.insert(point.varied.at("membrane.young_dyn_per_cm2"));
    EXPECT_FALSE(is_inside(box, point)); // a campaign that does not vary them has no such point
  }
  EXPECT_EQ(moduli.size(), 12u);
  EXPECT_LT(*moduli.begin(), 1.3e7);
  EXPECT_GT(*moduli.rbegin(), 2.7e7);
  for (const auto& point : plan.held_out) EXPECT_EQ(point.varied.size(), 2u);
  auto outside = plan.training.back();
  outside.varied["membrane.damping_time_s"] = 3e-4;
  EXPECT_FALSE(is_inside(box, outside, varied));
}

TEST(Plan, RefusesEmptyBoxesAndImpossibleCounts) {
  auto box = pump_box(5, 3);
  box.stroke_low = 0.09;
  EXPECT_THROW(plan_samples(box), InputError);
  EXPECT_THROW(plan_samples(pump_box(-1, 3)), InputError);
  box = pump_box(0, 1);
  box.frequency_high = 80, box.stroke_high = 0.01, box.head_high = 0;
  EXPECT_THROW(plan_samples(box), InputError);
  box.held_out_points = 0;
  EXPECT_EQ(plan_samples(box).training.size(), 1u);
}

} // namespace
} // namespace undula::training
