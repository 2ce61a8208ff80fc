// What a run comes to as a point of a curve.
#include <gtest/gtest.h>

#include <cmath>

#include "fom/levels/marched_curve.hpp"

namespace undula::fom {
namespace {

/// Four periods with outflows 4, 1, 2, 3 l/min.
PeriodicRun four_periods(RunState state) {
  PeriodicRun record;
  record.state = state;
  record.seconds["total"] = 1;
  record.plain_periods = 4;
  record.cycles.columns = {"outflow_l_per_min", "inflow_l_per_min", "hydraulic_power_mW",
                           "speed_max_cm_per_s", "clearance_min_mm"};
  const std::vector<double> flows = {4, 1, 2, 3};
  for (std::size_t period = 0; period < flows.size(); ++period) {
    record.cycles.periods.push_back(static_cast<int>(period) + 1);
    for (const double value : {flows[period], flows[period] + 10, 5.0, 6.0, 7.0}) {
      record.cycles.mean.push_back(value);
      record.cycles.minimum.push_back(value - static_cast<double>(period));
      record.cycles.maximum.push_back(value - static_cast<double>(period) + 100);
    }
  }
  return record;
}

TEST(CurvePoint, OfAPeriodicRunIsItsLastPeriod) {
  const CurvePoint point = curve_point(four_periods(RunState::periodic), 40);
  EXPECT_NEAR(point.head_mmHg, 40, 1e-12);
  EXPECT_EQ(point.flow_l_per_min, 3);
  EXPECT_EQ(point.inflow_l_per_min, 13);
  EXPECT_EQ(point.spread_l_per_min, 2);
  EXPECT_EQ(point.speed_max_cm_per_s, 103);
  EXPECT_EQ(point.clearance_min_mm, 4);
  EXPECT_EQ(point.periods, 4);
  EXPECT_TRUE(point.periodic);
  EXPECT_TRUE(std::isnan(point.holder_power_mW)); // not recorded
}

TEST(CurvePoint, OfARunThatDoesNotRepeatCountsWhatItsTransientLeaves) {
  PeriodicRun record = four_periods(RunState::not_periodic);
  const CurvePoint point = curve_point(record, 40);
  EXPECT_EQ(point.averaged_periods, 3);
  EXPECT_EQ(point.spread_l_per_min, 2);
  // s / sqrt(3) = 1 / sqrt(3), neighbours correlate by 0 + 1 / 3: times sqrt(2).
  EXPECT_NEAR(point.standard_error_l_per_min, std::sqrt(2.0 / 3), 1e-12);
  // Two periods after a jump: no mean, the last one.
  record.plain_periods = 2;
  const CurvePoint jumped = curve_point(record, 40);
  EXPECT_EQ(jumped.flow_l_per_min, 3);
  EXPECT_EQ(jumped.averaged_periods, 1);
  EXPECT_TRUE(std::isnan(jumped.standard_error_l_per_min));
  EXPECT_EQ(point.flow_l_per_min, 2);
  EXPECT_EQ(point.inflow_l_per_min, 12);
  EXPECT_EQ(point.speed_max_cm_per_s, 105);
  EXPECT_EQ(point.clearance_min_mm, 4);
  EXPECT_FALSE(point.periodic);
}

TEST(CurvePoint, OfAFailedRunHasNoFlow) {
  PeriodicRun record = four_periods(RunState::failed);
  record.reason = "diverged";
  const CurvePoint point = curve_point(record, 40);
  EXPECT_TRUE(std::isnan(point.flow_l_per_min));
  EXPECT_TRUE(std::isnan(point.spread_l_per_min));
  EXPECT_EQ(point.reason, "diverged");
}

} // namespace
} // namespace undula::fom
