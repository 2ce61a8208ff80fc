#include "apps/input/scene_at_point.hpp"

#include <gtest/gtest.h>

#include "rom/base/error.hpp"

namespace undula::apps {
namespace {

TEST(SceneAtPoint, KeysOfTheSectionAloneAreMovedAndTolerancesStay) {
  const std::string scene =
      "name = \"x\"\n\n[actuator]\nhead_mmHg = 1.0\n\n[operating_point]\nfrequency_Hz = 120.0\n"
      "stroke_mm = { value = 0.53, tolerance = 0.01 }\ndrive = \"stroke\"\n\n[mesh]\nfrequency_Hz = 2.0\n";
  EXPECT_EQ(
      scene_at_point(scene, {{"frequency_Hz", 97.5}, {"stroke_mm", 1}, {"head_mmHg", -1e-20}}),
      "name = \"x\"\n\n[actuator]\nhead_mmHg = 1.0\n\n[operating_point]\nhead_mmHg = -1e-20\nfrequency_Hz = "
      "97.5\n"
      "stroke_mm = { value = 1.0, tolerance = 0.01 }\ndrive = \"stroke\"\n\n[mesh]\nfrequency_Hz = 2.0\n");
}

TEST(SceneAtPoint, ATextWithoutAnOperatingPointIsRefused) {
  EXPECT_THROW(scene_at_point("name = \"x\"\n", {{"head_mmHg", 1}}), InputError);
  EXPECT_THROW(scene_at_point("", {}), InputError);
}

} // namespace
} // namespace undula::apps
