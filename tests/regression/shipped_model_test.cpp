// The shipped reduced model: what it answers, and how that compares with the full-order runs recorded in it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "rom/base/units.hpp"
#include "rom/curve/hq_curve.hpp"
#include "rom/fixed_domain/model.hpp"
#include "rom/fixed_domain/periodic.hpp"
#include "rom/fixed_domain/time_march.hpp"

namespace undula::rom {
namespace {

const Model& shipped() {
  static const Model model = load_model(UNDULA_SOURCE_DIR "/data/models/wave_pump_fixed.h5");
  return model;
}

double flow_range() {
  const auto& runs = shipped().references;
  const auto [low, high] = std::minmax_element(runs.begin(), runs.end(), [](const auto& a, const auto& b) {
    return a.flow_l_per_min < b.flow_l_per_min;
  });
  return high->flow_l_per_min - low->flow_l_per_min;
}

double flow_of(const Operators& operators, const ReferencePoint& run, int steps_per_period) {
  PeriodicOptions options;
  options.march_periods = 0;
  PeriodicSolver solver(operators, run.frequency_Hz, steps_per_period, options);
  const auto state =
      solver.solve(units::length_from_mm(run.stroke_mm), units::pressure_from_mmHg(run.head_mmHg));
  return state.converged ? units::flow_to_l_per_min(state.mean_outflow) : std::nan("");
}

TEST(ShippedModel, HasAtLeastEightHeldOutRunsInsideItsBox) {
  const auto& model = shipped();
  int held_out = 0;
  for (const auto& run : model.references) {
    if (!run.held_out) continue;
    ++held_out;
    EXPECT_GT(run.frequency_Hz, model.box.frequency_low_Hz);
    EXPECT_LT(run.frequency_Hz, model.box.frequency_high_Hz);
    EXPECT_GT(run.head_mmHg, model.box.head_low_mmHg);
    EXPECT_LT(run.head_mmHg, model.box.head_high_mmHg);
  }
  EXPECT_GE(held_out, 8);
}

TEST(ShippedModel, MeetsTheHeldOutRuns) {
  const auto& model = shipped();
  for (const auto& run : model.references) {
    if (!run.held_out) continue;
    const double flow = flow_of(model.operators, run, model.steps_per_period);
    EXPECT_NEAR(flow, run.rom_flow_l_per_min, 1e-6) << "the recorded answer is not the one given now";
    EXPECT_LT(std::abs(flow - run.flow_l_per_min), 0.01 * flow_range())
        << run.frequency_Hz << " Hz " << run.stroke_mm << " mm " << run.head_mmHg << " mmHg";
    EXPECT_LT(run.velocity_error, 0.03)
        << run.frequency_Hz << " Hz " << run.stroke_mm << " mm " << run.head_mmHg;
    EXPECT_LT(run.envelope_error, 0.02)
        << run.frequency_Hz << " Hz " << run.stroke_mm << " mm " << run.head_mmHg;
  }
}

TEST(ShippedModel, ErrorFallsAsModesAreAdded) {
  const auto& model = shipped();
  const auto& full = model.operators;
  std::vector<double> worst;
  for (const double share : {0.25, 0.5, 1.0}) {
    const auto part = [&](int modes) { return std::max(1, static_cast<int>(std::lround(share * modes))); };
    const auto reduced = restrict_operators(full, part(full.velocity_modes - full.supremizer_modes),
                                            part(full.pressure_modes), part(full.displacement_modes));
    double error = 0;
    for (const auto& run : model.references)
      if (run.held_out)
        error = std::max(error, std::abs(flow_of(reduced, run, model.steps_per_period) - run.flow_l_per_min));
    worst.push_back(error);
    std::printf("%3.0f %% of the modes: worst flow error on held-out runs %.4f l/min\n", 100 * share, error);
  }
  EXPECT_LT(worst[2], worst[1]);
  EXPECT_LT(worst[1], worst[0]);
}

TEST(ShippedModel, DoesNotDriftOver200Periods) {
  const auto& model = shipped();
  const double frequency = 120, stroke = units::length_from_mm(0.53), head = units::pressure_from_mmHg(50);
  PeriodicSolver solver(model.operators, frequency, model.steps_per_period);
  const auto direct = solver.solve(stroke, head);
  ASSERT_TRUE(direct.converged && direct.direct);
  TimeMarch march(model.operators, {frequency, stroke, head}, model.steps_per_period, 1.0);
  double after_100 = 0, after_200 = 0;
  for (int period = 1; period <= 200; ++period) {
    const auto record = march.period();
    if (period == 100) after_100 = record.mean_outflow;
    if (period == 200) after_200 = record.mean_outflow;
  }
  const double range = units::flow_from_l_per_min(flow_range());
  std::printf("mean flow after 100 and 200 periods from rest, and direct: %.5f %.5f %.5f l/min\n",
              units::flow_to_l_per_min(after_100), units::flow_to_l_per_min(after_200),
              units::flow_to_l_per_min(direct.mean_outflow));
  EXPECT_LT(std::abs(after_200 - after_100), 1e-3 * range);
  EXPECT_LT(std::abs(after_200 - direct.mean_outflow), 1e-3 * range);
}

TEST(ShippedModel, SaysWhenItIsAskedBeyondItsBox) {
  const double heads[] = {50.0, 90.0};
  const auto points = hq_curve(shipped(), 120, 0.53, heads);
  EXPECT_TRUE(points[0].inside_training_box);
  EXPECT_FALSE(points[1].inside_training_box);
  EXPECT_GT(points[0].error_l_per_min, 0.0);
}

TEST(ShippedModel, RecordsWhereItComesFrom) {
  const auto& provenance = shipped().provenance;
  for (const char* key : {"scene", "scene_hash", "version", "commit", "ranks"})
    EXPECT_TRUE(provenance.contains(key)) << key;
}

} // namespace
} // namespace undula::rom
