// The whole pump at the thin-gap level: leakage, volume, energy, order in time, convergence in cells.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fom/levels/march.hpp"
#include "fom/levels/thin_gap_level.hpp"
#include "fom/output/step_table.hpp"
#include "fom/scene/scene_time.hpp"
#include "tests/verification/support/names.hpp"
#include "tests/verification/support/thin_gap_scene.hpp"

namespace undula::verification {
namespace {

/// What a run leaves.
struct Run {
  TimeSeries table;
  State state;
  std::vector<PeriodSummary> periods;
  double worst_continuity = 0; ///< largest |inflow - outflow| over the largest flow
};

Run run(const Scene& scene, const ThinGapModel& model) {
  Run result;
  result.table.columns = observation_columns();
  result.state = initial_state(model);
  PhaseTimer timer;
  double difference = 0, flow = 0;
  ThinGapLevel level(model);
  march(level, scene, result.state, timer, [&](const State& state, const Observation& seen) {
    result.table.steps.push_back(state.step);
    const auto row = observation_row(seen);
    result.table.values.insert(result.table.values.end(), row.begin(), row.end());
    difference = std::max(difference, std::abs(seen.inflow - seen.outflow));
    flow = std::max(flow, std::abs(seen.outflow));
  });
  result.worst_continuity = difference / flow;
  result.periods = summarise_periods(result.table, scene.time.steps_per_period);
  return result;
}

Run run(const std::vector<std::string>& overrides) {
  const Scene scene = thin_gap_scene(overrides);
  PhaseTimer timer;
  return run(scene, prepare_thin_gap(scene, timer));
}

class PassivePump : public testing::TestWithParam<const char*> {};

/// The linear plate, pressed towards the upper flange, lets the flow through in a weak oscillation of its
/// own; the stretched one comes to rest, where the energy balance has no error of the time scheme left.
TEST_P(PassivePump, LeaksBackwardsAgainstItsHead) {
  const std::string solid = GetParam();
  constexpr int steps = 72, periods = 40;
  const auto result = run({"operating_point.stroke_mm=0", "operating_point.head_mmHg=40",
                           "time.periods=" + std::to_string(periods), "model.solid=\"" + solid + "\""});
  const auto& columns = result.table.columns;
  const auto outflow = static_cast<std::size_t>(
      std::find(columns.begin(), columns.end(), "outflow_l_per_min") - columns.begin());
  double least = 1e300, most = -1e300;
  for (std::size_t row = steps * (periods - 20); row < result.table.rows(); ++row) {
    least = std::min(least, result.table.value(row, outflow));
    most = std::max(most, result.table.value(row, outflow));
  }
  const auto& last = result.periods.back();
  std::printf("stroke 0, head 40 mmHg, %s: outflow %.4f .. %.4f l/min over 20 periods; energy gap %+.5f %%\n",
              solid.c_str(), least, most, 100 * last.energy_gap);
  EXPECT_LT(most, -1);
  EXPECT_LT(std::abs(last.energy_gap), 0.005);
  EXPECT_LT(result.worst_continuity, 1e-9);
  if (solid == "von-karman") {
    EXPECT_LT(most - least, 1e-3 * std::abs(least));
    EXPECT_LT(std::abs(last.energy_gap), 1e-5);
  }
}
INSTANTIATE_TEST_SUITE_P(Solids, PassivePump, testing::Values("linear", "von-karman"),
                         [](const auto& instance) {
                           return std::string(instance.param) == "linear" ? "Linear" : "VonKarman";
                         });

class WorkingPump : public testing::TestWithParam<double> {};

/// What the membrane takes above it gives below, so that the flows through the openings agree at every
/// instant.
TEST_P(WorkingPump, KeepsVolumeAndEnergy) {
  const auto result = run({"operating_point.stroke_mm=" + std::to_string(GetParam()), "time.periods=10",
                           "thin_gap.newton_tolerance=1e-7"});
  for (std::size_t i = result.periods.size() - 3; i < result.periods.size(); ++i) {
    const auto& period = result.periods[i];
    std::printf(
        "stroke %.2f mm, head 50 mmHg, period %d: outflow %.5f l/min, inflow - outflow %.1e, input %.3f mW, "
        "energy gap %+.3f %%, least clearance %.4f mm\n",
        GetParam(), period.period, period.outflow_l_per_min,
        period.inflow_l_per_min - period.outflow_l_per_min, period.input_power_mW, 100 * period.energy_gap,
        period.clearance_min_mm);
    EXPECT_NEAR(period.inflow_l_per_min, period.outflow_l_per_min, 1e-9 * std::abs(period.outflow_l_per_min));
    EXPECT_LT(std::abs(period.energy_gap), 0.005);
    EXPECT_GT(period.input_power_mW, 0);
  }
  std::printf("  largest |inflow - outflow| / largest flow: %.1e\n", result.worst_continuity);
  EXPECT_LT(result.worst_continuity, 1e-9);
}
INSTANTIATE_TEST_SUITE_P(Strokes, WorkingPump, testing::Values(0.3, 0.53), [](const auto& instance) {
  return "Stroke" + std::to_string(static_cast<int>(std::lround(100 * instance.param)));
});

class ThinGapTime : public testing::TestWithParam<const char*> {};

/// A smooth start at small amplitude without contact: deflection of the tip after one period, by Richardson.
TEST_P(ThinGapTime, HasTheOrderOfItsScheme) {
  const std::string scheme = GetParam();
  const double expected = scheme == "bdf2" ? 2 : 1;
  const Scene base = thin_gap_scene({"thin_gap.cells=32"});
  PhaseTimer timer;
  const auto model = prepare_thin_gap(base, timer);
  std::vector<Eigen::VectorXd> ends;
  const std::vector<int> steps = {96, 192, 384, 768};
  for (const int n : steps) {
    Scene scene =
        thin_gap_scene({"thin_gap.cells=32", "operating_point.stroke_mm=0.02", "operating_point.head_mmHg=0",
                        "thin_gap.newton_tolerance=1e-9", "time.scheme=\"" + scheme + "\"",
                        "time.steps_per_period=" + std::to_string(n), "time.periods=1"});
    scene.time.ramp_periods = 2;
    ends.push_back(run(scene, model).state.d[0]);
  }
  for (std::size_t i = 0; i + 2 < ends.size(); ++i) {
    const double order = std::log2((ends[i] - ends[i + 1]).norm() / (ends[i + 1] - ends[i + 2]).norm());
    std::printf("%s, %d, %d, %d steps per period: order %.3f (change %.3f %%)\n", GetParam(), steps[i],
                steps[i + 1], steps[i + 2], order, 100 * (ends[i] - ends[i + 1]).norm() / ends[i].norm());
    EXPECT_NEAR(order, expected, 0.2);
  }
}
INSTANTIATE_TEST_SUITE_P(Schemes, ThinGapTime, testing::Values("bdf1", "bdf2"),
                         [](const auto& instance) { return std::string(instance.param); });

/// The mean flow is a small difference of what the two halves of a stroke move.
TEST(ThinGapCells, TheMeanFlowConverges) {
  std::vector<double> flow;
  for (const int cells : {48, 96, 192}) {
    const auto result = run({"thin_gap.cells=" + std::to_string(cells)});
    flow.push_back(result.periods.back().outflow_l_per_min);
    std::printf("%d cells: mean flow %.5f l/min (period before %.5f)\n", cells, flow.back(),
                result.periods[result.periods.size() - 2].outflow_l_per_min);
  }
  const double order = std::log2((flow[1] - flow[0]) / (flow[2] - flow[1]));
  const double limit =
      flow[2] + (flow[2] - flow[1]) * (flow[2] - flow[1]) / (flow[1] - flow[0] - flow[2] + flow[1]);
  std::printf("order %.2f, limit %.5f l/min: 96 cells %+.2f %%, 192 cells %+.2f %%\n", order, limit,
              100 * (flow[1] / limit - 1), 100 * (flow[2] / limit - 1));
  EXPECT_GT(order, 1.5);
  EXPECT_LT(std::abs(flow[2] - limit), 0.03 * limit);
}

} // namespace
} // namespace undula::verification
