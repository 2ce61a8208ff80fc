// Weights of the stabilisation to start from.
#pragma once

#include "fom/problem/stabilisation_weights.hpp"

namespace undula::fom {

/// Weights that work from Re 0 to 1000 (docs/writing_a_scene.md): convection is penalised by the flow across
/// a facet, so that a fluid at rest or along a wall is left alone. `speed` (cm/s): of the fastest flow, see
/// stated_speed; `step` (s): the time step, however long.
///
/// With `velocity_order` 2 the pair with a linear pressure is stable by itself: penalties stay at cuts, and a
/// small one on jumps of the velocity. Nitsche's grows as the inverse inequality of the degree.
constexpr StabilisationWeights derived_weights(double speed, double step, int velocity_order = 1) {
  StabilisationWeights weights;
  weights.velocity_jump = 0.01;
  weights.pressure_jump = 0.05;
  weights.divergence = 0.005;
  weights.ghost_viscous = 0.1;
  weights.ghost_inertial = 0.05;
  weights.ghost_pressure = 0.05;
  weights.nitsche_viscous = 20;
  weights.nitsche_normal = 1;
  weights.reference_velocity = speed;
  weights.reference_time = step;
  weights.velocity_scale = VelocityScale::local;
  if (velocity_order == 2) {
    weights.velocity_jump = 0.001;
    weights.pressure_jump = weights.divergence = 0;
    weights.nitsche_viscous = 40;
  }
  return weights;
}

/// Weights of Undula's pump of fixed geometry and of its reduced models. They do not depend on the flow, so
/// that they can be projected; they stop the flutter of flags.
constexpr StabilisationWeights published_weights(double speed, double time) {
  StabilisationWeights weights = derived_weights(speed, time);
  weights.velocity_jump = 0.05;
  weights.divergence = 0.05;
  weights.velocity_scale = VelocityScale::reference;
  return weights;
}

} // namespace undula::fom
