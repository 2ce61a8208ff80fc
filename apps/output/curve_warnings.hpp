// What a user has to know before believing a curve.
#pragma once

#include <span>
#include <string>

#include "apps/apps.hpp"
#include "fom/levels/level.hpp"

namespace undula::apps {

/// "the narrowest film has fewer than four elements in 61 % of the period ..."
std::string film_remark(double unresolved_percent, double least_elements);

/// Logs the remarks of the level, the heads without a periodic state, films that are not resolved, and where
/// the membrane has passed through a wall.
void warn_of_curve(const Level& level, const Scene& scene, std::span<const CurvePoint> points);

} // namespace undula::apps
