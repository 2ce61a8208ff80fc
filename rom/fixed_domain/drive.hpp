// What drives the pump: frequency, stroke and head, their smooth start, and the time scheme's difference
// formula.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

namespace undula::rom {

/// Operating point in cgs units.
struct Drive {
  double frequency = 0; ///< Hz
  double stroke = 0;    ///< cm, amplitude of the holder's displacement stroke * sin(2 pi frequency t)
  double head = 0;      ///< dyn/cm^2, outlet minus inlet pressure
};

/// Weights of y^{n+1}, y^n, y^{n-1} in dt * dy/dt at t^{n+1}. BDF2; the first step, with no history, is BDF1.
using DifferenceWeights = std::array<double, 3>;
inline constexpr DifferenceWeights bdf1_weights{1.0, -1.0, 0.0};
inline constexpr DifferenceWeights bdf2_weights{1.5, -2.0, 0.5};

/// Smooth start: 0 at t = 0, 1 from `duration` (s) on; 1 throughout without a duration.
inline double ramp(double time, double duration) {
  if (time >= duration) return 1.0;
  return time <= 0 ? 0.0 : 0.5 * (1.0 - std::cos(std::numbers::pi * time / duration));
}

} // namespace undula::rom
