#include "rom/base/smooth_ramp.hpp"

#include <gtest/gtest.h>

namespace undula {
namespace {

TEST(SmoothRamp, RisesFromZeroToOneWithoutKinks) {
  EXPECT_EQ(smooth_ramp(0, 2), 0);
  EXPECT_DOUBLE_EQ(smooth_ramp(1, 2), 0.5);
  EXPECT_EQ(smooth_ramp(2, 2), 1);
  EXPECT_EQ(smooth_ramp(3, 2), 1);
  EXPECT_EQ(smooth_ramp(0.1, 0), 1);
  EXPECT_LT(smooth_ramp(1e-3, 2), 1e-5);
}

} // namespace
} // namespace undula
