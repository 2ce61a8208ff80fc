#include "rom/curve/hq_curve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "rom/base/error.hpp"
#include "rom/base/units.hpp"
#include "rom/curve/error_estimate.hpp"
#include "rom/fixed_domain/continuation.hpp"
#include "synthetic_operators.hpp"

namespace undula::rom {
namespace {

Model synthetic_model(double convection) {
  Model model;
  model.operators = synthetic_operators({24, 8, 5}, convection);
  model.steps_per_period = 96;
  model.box = {80, 140, 0.1, 0.8, 0, 70};
  model.error_safety = 2;
  model.error_floor_l_per_min = 0.125;
  return model;
}

std::vector<double> twelve_heads() {
  std::vector<double> heads;
  for (int i = 0; i < 12; ++i) heads.push_back(40 + 2 * i);
  return heads;
}

TEST(HqCurve, IsAStraightLineWithoutConvection) {
  const auto points = hq_curve(synthetic_model(0), 100, 0.5, twelve_heads());
  ASSERT_EQ(points.size(), 12u);
  const double slope = (points[11].flow_l_per_min - points[0].flow_l_per_min) / 22;
  EXPECT_LT(slope, -1e-3) << "a higher head must lower the flow";
  for (const auto& p : points)
    EXPECT_NEAR(p.flow_l_per_min, slope * p.head_mmHg, 1e-9) << "no convection: no flow without head";
}

TEST(HqCurve, ConvectionBendsIt) {
  const auto points = hq_curve(synthetic_model(30), 100, 0.5, twelve_heads());
  const double first = points[1].flow_l_per_min - points[0].flow_l_per_min;
  const double last = points[11].flow_l_per_min - points[10].flow_l_per_min;
  EXPECT_GT(std::abs(first - last), 1e-2 * std::abs(first));
}

TEST(HqCurve, EqualsTheMarchPointByPoint) {
  const auto model = synthetic_model(30);
  const std::vector<double> heads = {55, 0, 20, 55};
  HqOptions plain;
  plain.periodic.direct = false;
  plain.periodic.march_tolerance = 1e-11;
  HqOptions tight;
  tight.periodic = PeriodicOptions{}; // eight digits, where a curve by default has six
  const auto direct = hq_curve(model, 100, 0.5, heads, tight),
             marched = hq_curve(model, 100, 0.5, heads, plain);
  for (std::size_t i = 0; i < heads.size(); ++i) {
    EXPECT_TRUE(direct[i].direct && direct[i].converged);
    EXPECT_FALSE(marched[i].direct);
    EXPECT_EQ(direct[i].head_mmHg, heads[i]);
    EXPECT_NEAR(direct[i].flow_l_per_min, marched[i].flow_l_per_min,
                1e-6 * std::abs(marched[i].flow_l_per_min));
    EXPECT_LT((direct[i].envelope_low_mm - marched[i].envelope_low_mm).norm(), 1e-5);
    EXPECT_LT((direct[i].envelope_high_mm - marched[i].envelope_high_mm).norm(), 1e-5);
    EXPECT_GT((direct[i].envelope_high_mm - direct[i].envelope_low_mm).minCoeff(), 0.1);
    const double power =
        units::pressure_from_mmHg(heads[i]) * units::flow_from_l_per_min(direct[i].flow_l_per_min);
    EXPECT_NEAR(direct[i].hydraulic_power_mW, power * 1e-4, 1e-9 * std::abs(power));
  }
  EXPECT_NEAR(direct[0].flow_l_per_min, direct[3].flow_l_per_min, 1e-7 * std::abs(direct[0].flow_l_per_min));
}

TEST(HqCurve, EnvelopeOfARigidMembraneIsTheStroke) {
  auto model = synthetic_model(0);
  model.operators.envelope.setZero();
  const auto points = hq_curve(model, 100, 0.5, std::vector<double>{10});
  EXPECT_NEAR(points[0].envelope_high_mm.maxCoeff(), 0.5, 1e-12);
  EXPECT_NEAR(points[0].envelope_low_mm.minCoeff(), -0.5, 1e-12);
}

TEST(HqCurve, FlagsEveryParameterOutsideTheTrainingBox) {
  const auto model = synthetic_model(1);
  const std::vector<double> heads = {69, 71};
  const auto points = hq_curve(model, 100, 0.5, heads);
  EXPECT_TRUE(points[0].inside_training_box);
  EXPECT_FALSE(points[1].inside_training_box);
  EXPECT_FALSE(hq_curve(model, 79, 0.5, heads)[0].inside_training_box);
  EXPECT_FALSE(hq_curve(model, 100, 0.81, heads)[0].inside_training_box);
  EXPECT_TRUE(outside_training_box(model.box, 80, 0.1, std::vector<double>{0}).empty());
  const auto lines = outside_training_box(model.box, 150, 0.05, heads);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0], "frequency 150 Hz is outside the trained 80 to 140 Hz");
}

TEST(HqCurve, RefusesWrongInput) {
  const auto model = synthetic_model(1);
  const std::vector<double> heads = {10};
  EXPECT_THROW(hq_curve(model, 0, 0.5, heads), InputError);
  EXPECT_THROW(hq_curve(model, 100, -0.5, heads), InputError);
  EXPECT_THROW(hq_curve(model, 100, 0.5, std::vector<double>{std::nan("")}), InputError);
  EXPECT_TRUE(hq_curve(model, 100, 0.5, std::vector<double>{}).empty());
}

TEST(HqCurve, ErrorIsSafetyTimesIndicatorPlusFloor) {
  auto model = synthetic_model(30);
  const std::vector<double> heads = {10, 50};
  const auto points = hq_curve(model, 100, 0.5, heads);
  for (const auto& p : points) {
    EXPECT_GT(p.indicator_l_per_min, 0);
    EXPECT_TRUE(p.error_calibrated);
    EXPECT_DOUBLE_EQ(p.error_l_per_min, 2 * p.indicator_l_per_min + 0.125);
  }
  model.error_safety = model.error_floor_l_per_min = 0;
  const auto raw = hq_curve(model, 100, 0.5, heads);
  EXPECT_FALSE(raw[0].error_calibrated);
  EXPECT_DOUBLE_EQ(raw[0].error_l_per_min, raw[0].indicator_l_per_min);
  HqOptions without;
  without.estimate_errors = false;
  EXPECT_TRUE(std::isnan(hq_curve(model, 100, 0.5, heads, without)[0].error_l_per_min));
}

TEST(HqCurve, TheErrorGrowsOutsideOfTheBoxUntilItIsUnknown) {
  const auto model = synthetic_model(30);
  const std::vector<double> heads = {10};
  const auto error = [&](double frequency_Hz, double stroke_mm) {
    return hq_curve(model, frequency_Hz, stroke_mm, heads)[0];
  };
  // The box: 80 to 140 Hz, 0.1 to 0.8 mm, 0 to 70 mmHg.
  const auto near = error(146, 0.5);
  EXPECT_DOUBLE_EQ(near.error_l_per_min, 4 * (2 * near.indicator_l_per_min + 0.125));
  EXPECT_TRUE(std::isinf(error(2, 0.5).error_l_per_min));
  EXPECT_TRUE(std::isinf(error(100, 3).error_l_per_min));
}

TEST(ErrorEstimate, GrowsWithTheDistanceFromTheBox) {
  TrainingBox box;
  box.frequency_low_Hz = 80;
  box.frequency_high_Hz = 140;
  box.stroke_low_mm = 0.1;
  box.stroke_high_mm = 0.8;
  box.head_low_mmHg = 0;
  box.head_high_mmHg = 70;
  EXPECT_EQ(growth_outside_box(box, 80, 0.8, 70 * (1 + 1e-12)), 1);
  double last = 1;
  for (const double off : {1.0, 5.0, 10.0, 20.0, 30.0}) {
    const double growth = growth_outside_box(box, 140 + off, 0.5, 35);
    EXPECT_GT(growth, last);
    last = growth;
  }
  EXPECT_TRUE(std::isinf(growth_outside_box(box, 171, 0.5, 35)));
  EXPECT_GT(growth_outside_box(box, 150, 0.5, 80), growth_outside_box(box, 150, 0.5, 35));
  box.frequency_low_Hz = box.frequency_high_Hz = 120; // of one frequency nothing is known about another
  EXPECT_TRUE(std::isinf(growth_outside_box(box, 121, 0.5, 35)));
  EXPECT_EQ(growth_outside_box(box, 120, 0.5, 35), 1);
}

TEST(ErrorEstimate, IndicatorIsTheDifferenceToTheSmallerModel) {
  const auto o = synthetic_operators({20, 6, 4}, 30.0);
  const auto state = PeriodicSolver(o, 100, 96).solve(0.05, 2e4);
  const auto fewer = restrict_operators(o, 14, 5, 3);
  const auto coarse = PeriodicSolver(fewer, 100, 96).solve(0.05, 2e4);
  const double exact = std::abs(state.mean_outflow - coarse.mean_outflow);
  EXPECT_NEAR(FlowIndicator(o, 100, 96)(0.05, 2e4, state), exact, 0.02 * exact);
}

TEST(ErrorEstimate, CalibrationBoundsEveryPointTightly) {
  // error = 2 indicator + 0.1 exactly: the fit is that line, and no point left out exceeds it.
  const std::vector<double> x = {0.1, 0.5, 0.2, 0.9, 0.4};
  std::vector<double> y;
  for (const double v : x) y.push_back(2 * v + 0.1);
  auto fit = calibrate_error_estimate(x, y);
  EXPECT_NEAR(fit.safety, 2, 1e-12);
  EXPECT_NEAR(fit.floor, 0.1, 1e-12);
  EXPECT_NEAR(fit.worst_left_out, 1, 1e-12);

  // One bad point: the fit to the others misses it, which widens the estimate, which covers all.
  y[2] = 3.0;
  fit = calibrate_error_estimate(x, y);
  EXPECT_GE(fit.left_out_violations, 1);
  EXPECT_NEAR(fit.worst_left_out, 3.0 / 0.5, 1e-9);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_GE(fit.safety * x[i] + fit.floor, y[i]);

  EXPECT_THROW(calibrate_error_estimate(std::vector<double>{1, 2}, std::vector<double>{1, 2}), InputError);
  EXPECT_THROW(calibrate_error_estimate(x, std::vector<double>{1, 2, 3}), InputError);
  EXPECT_THROW(calibrate_error_estimate(x, std::vector<double>{1, 2, 3, -1, 2}), InputError);
}

TEST(HeadContinuation, InterpolatesPolynomialsExactlyFromTheEndsInwards) {
  const std::vector<double> heads = {10, 0, 40, 20, 30};
  EXPECT_EQ(HeadContinuation::order(heads).front(), 1u);
  EXPECT_EQ(HeadContinuation::order(heads)[1], 2u);
  EXPECT_EQ(HeadContinuation::order(heads)[2], 3u);
  HeadContinuation continuation;
  EXPECT_EQ(continuation.guess(5).size(), 0);
  for (const double h : {0.0, 40.0, 20.0, 20.0})
    continuation.add(h, Eigen::MatrixXd::Constant(2, 3, h * h - 3 * h));
  EXPECT_NEAR(continuation.guess(30)(1, 2), 30 * 30 - 90, 1e-10);
}

TEST(HeadContinuation, OrdersThousandsOfHeadsByTheFarthestNext) {
  std::vector<double> heads(10000);
  for (std::size_t i = 0; i < heads.size(); ++i) heads[i] = std::fmod(37.0 * static_cast<double>(i), 101.0);
  const auto order = HeadContinuation::order(heads); // as many as the command line takes; at once
  ASSERT_EQ(order.size(), heads.size());
  const auto to_solved = [&](std::size_t head, std::size_t solved) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < solved; ++j)
      nearest = std::min(nearest, std::abs(heads[head] - heads[order[j]]));
    return nearest;
  };
  EXPECT_EQ(heads[order[0]], 0);
  for (std::size_t solved = 1; solved < 120; ++solved)
    for (std::size_t i = 0; i < 101; ++i)
      EXPECT_GE(to_solved(order[solved], solved), to_solved(i, solved)) << solved;
  auto all = order;
  std::sort(all.begin(), all.end());
  for (std::size_t i = 0; i < all.size(); ++i) ASSERT_EQ(all[i], i);
}

} // namespace
} // namespace undula::rom
