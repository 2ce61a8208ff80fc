#include "rom/curve/pump_period.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "rom/base/error.hpp"
#include "rom/base/units.hpp"
#include "rom/curve/projected_curve.hpp"
#include "rom/curve/stated_drive.hpp"
#include "rom/fixed_domain/time_march.hpp"
#include "synthetic_operators.hpp"

namespace undula::rom {
namespace {

constexpr double frequency_Hz = 100, stroke_mm = 0.5, head_mmHg = 45;

Model synthetic_model() {
  Model model;
  model.operators = synthetic_operators({24, 8, 5}, 30);
  model.steps_per_period = 96;
  model.box = {80, 140, 0.1, 0.8, 0, 70};
  return model;
}

TEST(PumpPeriod, IsWhatThePlainMarchDoesStepByStep) {
  const Model model = synthetic_model();
  HqOptions tight;
  tight.periodic = PeriodicOptions{};
  const auto period = pump_period(model, frequency_Hz, stroke_mm, head_mmHg, tight);
  ASSERT_TRUE(period.periodic);
  const auto steps = static_cast<Eigen::Index>(model.steps_per_period);
  ASSERT_EQ(period.time_s.size(), steps);

  TimeMarch march(model.operators,
                  {frequency_Hz, units::length_from_mm(stroke_mm), units::pressure_from_mmHg(head_mmHg)},
                  model.steps_per_period, 2);
  for (int i = 0; i < 200 && (i < 4 || march.period().change > 1e-11); ++i) march.period();
  const Eigen::MatrixXd velocity = march.trajectory().topRows(model.operators.velocity_modes);
  const double scale = period.outflow_l_per_min.cwiseAbs().maxCoeff();
  EXPECT_GT(period.outflow_l_per_min.maxCoeff() - period.outflow_l_per_min.minCoeff(), 0.1 * scale)
      << "nothing pulsates";
  for (Eigen::Index j = 0; j < steps; ++j) {
    const Eigen::Index at = (j + 1) % steps; // of the march's column j
    EXPECT_NEAR(period.outflow_l_per_min[at],
                units::flow_to_l_per_min(model.operators.outflow.dot(velocity.col(j))), 1e-5 * scale);
    EXPECT_NEAR(period.inflow_l_per_min[at],
                units::flow_to_l_per_min(model.operators.inflow.dot(velocity.col(j))), 1e-5 * scale);
    const Eigen::VectorXd membrane =
        model.operators.envelope * march.displacement_trajectory().col(j) +
        model.operators.envelope_imposed * units::length_from_mm(period.holder_mm[at]);
    EXPECT_LT((10 * membrane - period.membrane_mm.col(at)).cwiseAbs().maxCoeff(), 1e-5);
  }
  EXPECT_NEAR(period.time_s[1], 1 / (frequency_Hz * 96), 1e-15);
  EXPECT_NEAR(period.holder_mm[24], stroke_mm, 1e-12) << "a quarter of a period after its middle";
}

TEST(PumpPeriod, HasTheMeansOfItsPointOnTheCurve) {
  const Model model = synthetic_model();
  const auto period = pump_period(model, frequency_Hz, stroke_mm, head_mmHg);
  const auto point = hq_curve(model, frequency_Hz, stroke_mm, std::vector<double>{head_mmHg}).front();
  EXPECT_NEAR(period.outflow_l_per_min.mean(), point.flow_l_per_min, 1e-12 * std::abs(point.flow_l_per_min));
  EXPECT_NEAR(period.inflow_l_per_min.mean(), point.inflow_l_per_min, 1e-12 * std::abs(point.flow_l_per_min));
  EXPECT_EQ(period.membrane_mm.rowwise().minCoeff(), point.envelope_low_mm);
  EXPECT_EQ(period.membrane_mm.rowwise().maxCoeff(), point.envelope_high_mm);
}

TEST(PumpPeriod, RefusesWhatIsNoOperatingPoint) {
  const Model model = synthetic_model();
  EXPECT_THROW(pump_period(model, 0, stroke_mm, head_mmHg), InputError);
  EXPECT_THROW(pump_period(model, frequency_Hz, -1, head_mmHg), InputError);
  EXPECT_THROW(pump_period(model, frequency_Hz, stroke_mm, std::nan("")), InputError);
}

TEST(ProjectedCurve, EndsWhereTheCallerThrows) {
  const Model model = synthetic_model();
  const std::vector<double> heads = {10, 20, 30, 40};
  int points = 0;
  EXPECT_THROW(projected_curve(model, frequency_Hz, stroke_mm, heads,
                               [&] {
                                 if (++points == 2) throw std::runtime_error("stop");
                               }),
               std::runtime_error);
  EXPECT_EQ(points, 2);
}

TEST(StatedDrive, IsOfTheModelsKindAndAlone) {
  EXPECT_EQ(drive_of({0.5, {}}, false, "the model", "m.h5"), 0.5);
  EXPECT_EQ(drive_of({{}, 40}, true, "the emulator", "m.h5"), 40);
  const auto message = [](const StatedDrive& stated, bool by_voltage) -> std::string {
    try {
      drive_of(stated, by_voltage, "the model", "m.h5");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(
      message({}, true),
      "the model is driven by a voltage\n  seen:    no voltage\n  allowed: a voltage (V) alone\n  where: "
      "  m.h5");
  EXPECT_NE(message({{}, 40}, false).find("no stroke, but a voltage of 40 V"), std::string::npos);
  EXPECT_NE(message({0.5, 40}, false).find("a stroke and a voltage of 40 V"), std::string::npos);
  EXPECT_NE(message({-0.5, {}}, false).find("> 0"), std::string::npos);
}

} // namespace
} // namespace undula::rom
