// Contact of the plate with a wall of its gap.
#pragma once

#include "fom/scene/scene.hpp"

namespace undula::fom {

/// Contact pressure at a gap of this height, dyn/cm^2: grows linearly below the film thickness, after a
/// smooth onset over a fifth of it.
template <typename Number>
Number contact_pressure(const ThinGapSettings& settings, const Number& height) {
  const double onset = settings.film_thickness / 5;
  const Number depth = settings.film_thickness - height;
  if (depth <= 0) return Number(0.0 * height);
  if (depth < onset) return Number(settings.contact_stiffness * depth * depth / (2 * onset));
  return Number(settings.contact_stiffness * (depth - 0.5 * onset));
}

/// Its integral from infinity down to `height`, dyn/cm.
inline double contact_energy(const ThinGapSettings& settings, double height) {
  const double onset = settings.film_thickness / 5, depth = settings.film_thickness - height;
  if (depth <= 0) return 0;
  if (depth < onset) return settings.contact_stiffness * depth * depth * depth / (6 * onset);
  const double past = depth - onset;
  return settings.contact_stiffness * (onset * onset / 6 + 0.5 * onset * past + 0.5 * past * past);
}

} // namespace undula::fom
