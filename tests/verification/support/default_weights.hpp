// The stabilisation weights that a scene gets by default, with the scales of a test.
#pragma once

#include "fom/scene/scene_table.hpp"
#include "tests/verification/support/names.hpp"

namespace undula::verification {

/// Defaults of scene_table.cpp; velocity in cm/s and time in s replace the pump's scales.
inline StabilisationWeights default_weights(double reference_velocity, double reference_time) {
  Scene scene;
  for (const auto& key : scene_table())
    if (key.section() == "stabilisation")
      if (const auto* real = std::get_if<RealKey>(&key.value))
        real->field(scene) = real->fallback.value() * real->cgs_per_unit;
  scene.stabilisation.reference_velocity = reference_velocity;
  scene.stabilisation.reference_time = reference_time;
  return scene.stabilisation;
}

} // namespace undula::verification
