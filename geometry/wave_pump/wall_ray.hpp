// What a vertical ray from the membrane meets.
#pragma once

#include <optional>

#include "geometry/wave_pump/profile.hpp"

namespace undula::geometry {

struct WallOnRay {
  double z = 0; ///< cm
  FluidOutline::Curve curve = FluidOutline::housing;
};

/// First edge of the outline met on the vertical through (r, z) upwards (up = true) or downwards, from but
/// not including z. Edges parallel to the ray do not count. Empty where there is none.
std::optional<WallOnRay> first_wall(const FluidOutline& outline, double r, double z, bool up);

} // namespace undula::geometry
