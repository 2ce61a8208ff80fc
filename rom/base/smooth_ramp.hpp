// A start without a jump in speed.
#pragma once

#include <cmath>
#include <numbers>

namespace undula {

/// 0 until t = 0, 1 from `duration` on, (1 - cos(pi t / duration)) / 2 between.
inline double smooth_ramp(double t, double duration) {
  if (t >= duration) return 1.0;
  return t <= 0 ? 0.0 : 0.5 * (1 - std::cos(std::numbers::pi * t / duration));
}

} // namespace undula
