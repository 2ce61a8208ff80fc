// The shipped emulator over frequency, voltage and head against runs of the same scene that it was not made
// from.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "rom/emulator/emulated_response.hpp"
#include "rom/emulator/emulator.hpp"

namespace undula::rom {
namespace {

const Emulator& wide() {
  static const Emulator emulator = load_emulator(UNDULA_SOURCE_DIR "/data/models/wave_pump_mapped_wide.h5");
  return emulator;
}

double flow(double frequency, double voltage, double head) {
  return emulate(wide(), {frequency, voltage, head}).values.front().value;
}

// Means of periods 6 to 8 of two runs (docs/mapped.md, "Order 2"), l/min.
TEST(WideEmulator, MeetsRunsThatItDoesNotKnowWithinItsError) {
  for (const auto& [head_mmHg, run] : {std::pair(50.0, 2.08), std::pair(60.0, 1.00)}) {
    const auto answer = emulate(wide(), {120, 40, head_mmHg}).values.front();
    EXPECT_LT(std::abs(answer.value - run), answer.error);
    EXPECT_LT(answer.error, 0.3);
    for (const auto& known : wide().runs) EXPECT_FALSE(known.point[1] == 40 && known.point[2] == head_mmHg);
  }
}

TEST(WideEmulator, CoversTheBoxAndSaysWhereItEnds) {
  EXPECT_EQ(wide().inputs[0].low, 100);
  EXPECT_EQ(wide().inputs[0].high, 140);
  EXPECT_TRUE(emulate(wide(), {101, 35, 21}).inside_training_box);
  EXPECT_FALSE(emulate(wide(), {145, 40, 50}).inside_training_box);
  for (const double frequency : {105.0, 120.0, 135.0})
    for (double voltage = 36; voltage <= 48; voltage += 2)
      for (double head = 25; head <= 70; head += 5) {
        EXPECT_GT(flow(frequency, voltage, head), flow(frequency, voltage, head + 5));
        EXPECT_LT(flow(frequency, voltage, head), flow(frequency, voltage + 2, head));
      }
}

// The wave runs inwards: the tip lags behind the rim, and the outflow's mean over the period is the mean
// flow.
TEST(WideEmulator, KnowsTheCourseOverAPeriod) {
  const auto* outflow = find_response(wide(), outflow_response);
  const auto* membrane = find_response(wide(), membrane_response);
  ASSERT_NE(outflow, nullptr);
  ASSERT_NE(membrane, nullptr);
  const EmulatorPoint point{120, 40, 50};
  const auto course = emulate(wide(), *outflow, point);
  EXPECT_NEAR(course.values.mean(), flow(120, 40, 50), course.error);
  const auto shape = emulate(wide(), *membrane, point);
  const Eigen::Index places = shape.values.rows();
  const double rim = shape.values.row(places - 1).maxCoeff(), tip = shape.values.row(0).maxCoeff();
  EXPECT_NEAR(rim, 0.58, 0.06); // mm, the stroke
  EXPECT_GT(tip, 1.5 * rim);
}

} // namespace
} // namespace undula::rom
