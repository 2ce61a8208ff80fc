// What a user has to know before believing a curve.
#pragma once

#include <span>

#include "apps/apps.hpp"
#include "fom/levels/level.hpp"

namespace undula::apps {

/// Logs the remarks of the level, the heads without a periodic state, and where the membrane has passed
/// through a wall.
void warn_of_curve(const Level& level, const Scene& scene, std::span<const CurvePoint> points);

} // namespace undula::apps
