// Which of several levels answers.
#include "fom/levels/hybrid_level.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace undula::fom {
namespace {

/// Answers `flow` with an error that grows with the head.
class Guess final : public Level {
public:
  Guess(double flow, double error_per_mmHg, std::vector<double>& asked)
      : flow_(flow), error_per_mmHg_(error_per_mmHg), asked_(asked) {}
  std::string name() const override { return "guess"; }
  int unknowns() const override { return 7; }
  std::vector<CurvePoint> curve(const Scene& scene, std::span<const double> heads_mmHg,
                                const std::function<void()>&) override {
    std::vector<CurvePoint> points;
    for (const double head : heads_mmHg) {
      asked_.push_back(head);
      CurvePoint point;
      point.head_mmHg = head;
      point.flow_l_per_min = flow_ + scene.operating_point.voltage;
      point.error_l_per_min = error_per_mmHg_ * head;
      points.push_back(point);
    }
    return points;
  }
  std::vector<std::string> remarks(const Scene&, std::span<const double>) const override { return {"rough"}; }

private:
  double flow_, error_per_mmHg_;
  std::vector<double>& asked_;
};

/// Marches: knows the standard error of its mean, or repeats.
class March final : public Level {
public:
  March(double standard_error, bool periodic) : standard_error_(standard_error), periodic_(periodic) {}
  std::string name() const override { return "march"; }
  int unknowns() const override { return 1; }
  std::vector<CurvePoint> curve(const Scene&, std::span<const double> heads_mmHg,
                                const std::function<void()>&) override {
    std::vector<CurvePoint> points(heads_mmHg.size());
    for (auto& point : points) {
      point.flow_l_per_min = 100;
      point.standard_error_l_per_min = standard_error_;
      point.periodic = periodic_;
    }
    return points;
  }
  std::vector<std::string> remarks(const Scene&, std::span<const double>) const override { return {}; }

private:
  double standard_error_;
  bool periodic_;
};

Scene at_voltage(double voltage) {
  Scene scene;
  scene.operating_point.drive = Drive::voltage;
  scene.operating_point.voltage = voltage;
  return scene;
}

struct Asked {
  std::vector<double> cheap, dear;
  int prepared = 0;

  std::vector<Tier> tiers(double cheap_error, double dear_error) {
    return {{"cheap", at_voltage(0),
             [this, cheap_error] { return std::make_unique<Guess>(1, cheap_error, cheap); }},
            {"dear", at_voltage(0), [this, dear_error] {
               ++prepared;
               return std::make_unique<Guess>(2, dear_error, dear);
             }}};
  }
};

const std::vector<double> heads{10, 20, 30};

TEST(HybridLevel, AsksTheNextLevelWhereTheFirstIsNotSureEnough) {
  Asked asked;
  HybridLevel level(asked.tiers(0.01, 0.001), 0.15);
  const auto points = level.curve(at_voltage(40), heads);
  ASSERT_EQ(points.size(), 3U);
  EXPECT_EQ(points[0].tier, "cheap");
  EXPECT_EQ(points[1].tier, "dear");
  EXPECT_EQ(points[2].tier, "dear");
  EXPECT_DOUBLE_EQ(points[0].flow_l_per_min, 41);
  EXPECT_DOUBLE_EQ(points[2].flow_l_per_min, 42);
  EXPECT_DOUBLE_EQ(points[2].error_l_per_min, 0.03);
  EXPECT_EQ(asked.dear, (std::vector<double>{20, 30}));
  EXPECT_NE(points[2].why.find("cheap: error 0.300"), std::string::npos) << points[2].why;
  EXPECT_NE(points[2].why.find("dear: error 0.030"), std::string::npos) << points[2].why;
  EXPECT_EQ(level.remarks(at_voltage(40), heads).size(), 2U);
}

TEST(HybridLevel, PreparesNoLevelThatIsNotNeeded) {
  Asked asked;
  HybridLevel level(asked.tiers(0.001, 0.001), 0.15);
  for (const auto& point : level.curve(at_voltage(0), heads)) EXPECT_EQ(point.tier, "cheap");
  EXPECT_EQ(asked.prepared, 0);
  EXPECT_EQ(level.remarks(at_voltage(0), heads).size(), 1U);
}

TEST(HybridLevel, TakesTheLeastErrorWhereNoneIsSureEnoughAndSaysSo) {
  Asked asked;
  HybridLevel level(asked.tiers(0.01, 0.02), 0.05);
  for (const auto& point : level.curve(at_voltage(0), heads)) {
    EXPECT_EQ(point.tier, "cheap");
    EXPECT_NE(point.why.find("none within 0.05"), std::string::npos) << point.why;
    EXPECT_GT(point.error_l_per_min, 0.05);
  }
}

TEST(HybridLevel, TakesTheStandardErrorOfLevelsThatStateNone) {
  for (const bool periodic : {true, false}) {
    Asked asked;
    auto tiers = asked.tiers(1, 1);
    tiers[1] = {"march", at_voltage(0), [periodic] { return std::make_unique<March>(0.2, periodic); }};
    HybridLevel level(tiers, 0.1);
    const auto points = level.curve(at_voltage(0), heads);
    EXPECT_EQ(points[0].tier, "march");
    EXPECT_DOUBLE_EQ(points[0].error_l_per_min, periodic ? 0 : 0.2);
    EXPECT_EQ(points[0].why.find("none within") == std::string::npos, periodic);
  }
}

TEST(HybridLevel, AnAnswerOfUnknownErrorIsBetterThanNone) {
  Asked asked;
  auto tiers = asked.tiers(1, 1);
  tiers[0] = {"failed", at_voltage(0),
              [&asked] { return std::make_unique<Guess>(std::nan(""), 1, asked.cheap); }};
  tiers[1] = {"march", at_voltage(0), [] { return std::make_unique<March>(std::nan(""), false); }};
  const auto point = HybridLevel(tiers, 0.1).curve(at_voltage(0), heads).front();
  EXPECT_EQ(point.tier, "march");
  EXPECT_DOUBLE_EQ(point.flow_l_per_min, 100);
}

TEST(HybridLevel, TellsOfEveryHeadOnce) {
  Asked asked;
  HybridLevel level(asked.tiers(0.01, 0.02), 0.15);
  int told = 0;
  level.curve(at_voltage(0), heads, [&told] { ++told; });
  EXPECT_EQ(told, 3);
}

TEST(HybridLevel, AnUnknownErrorIsNoSmallOne) {
  Asked asked;
  auto tiers = asked.tiers(1, 0.001);
  tiers[0] = {"march", at_voltage(0), [] { return std::make_unique<March>(std::nan(""), false); }};
  HybridLevel level(tiers, 0.1);
  EXPECT_EQ(level.curve(at_voltage(0), heads).front().tier, "dear");
}

} // namespace
} // namespace undula::fom
