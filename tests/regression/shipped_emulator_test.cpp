// The shipped emulator of the full order against runs of the same scene that it was not made from.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "rom/emulator/emulator.hpp"

namespace undula::rom {
namespace {

const Emulator& shipped() {
  static const Emulator emulator =
      load_emulator(UNDULA_SOURCE_DIR "/data/models/wave_pump_mapped_voltage.h5");
  return emulator;
}

// Means of periods 6 to 8 of two runs (docs/mapped.md, "Order 2"), l/min.
TEST(ShippedEmulator, MeetsRunsThatItDoesNotKnow) {
  for (const auto& [head_mmHg, flow] : {std::pair(50.0, 2.08), std::pair(60.0, 1.00)}) {
    const auto answer = emulate(shipped(), {120, 40, head_mmHg}).values.front();
    EXPECT_NEAR(answer.value, flow, 0.1);
    EXPECT_LT(answer.error, 0.25);
    EXPECT_GT(answer.error, std::abs(answer.value - flow));
    for (const auto& run : shipped().runs) EXPECT_FALSE(run.point[1] == 40 && run.point[2] == head_mmHg);
  }
}

TEST(ShippedEmulator, FallsWithTheHeadAndRisesWithTheVoltage) {
  const auto flow = [](double voltage, double head) {
    return emulate(shipped(), {120, voltage, head}).values.front().value;
  };
  for (double voltage = 39; voltage <= 49; voltage += 1)
    for (double head = 42; head <= 72; head += 2) {
      EXPECT_GT(flow(voltage, head), flow(voltage, head + 2));
      EXPECT_LT(flow(voltage, head), flow(voltage + 1, head));
    }
}

TEST(ShippedEmulator, RecordsWhereItComesFromWithoutThePlace) {
  const auto& provenance = shipped().provenance;
  for (const char* key : {"scene", "scene_hash", "version", "commit", "ranks"})
    EXPECT_TRUE(provenance.contains(key)) << key;
  EXPECT_EQ(provenance.at("scene").find("\"/"), std::string::npos);
}

} // namespace
} // namespace undula::rom
