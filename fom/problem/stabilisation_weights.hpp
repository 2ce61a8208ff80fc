// Weights of the stabilisation of the fluid.
#pragma once

namespace undula::fom {

/// Velocity that scales the penalty on jumps of the velocity gradient.
enum class VelocityScale {
  reference, ///< StabilisationWeights::reference_velocity, everywhere and always
  local      ///< of the flow across the facet
};

/// Weights of the stabilisation. They do not depend on the solution (the reduced model inherits them
/// exactly): phi = viscosity + density * reference_velocity * h + density * h^2 / reference_time.
struct StabilisationWeights {
  double velocity_jump = 0;  ///< CIP on [grad u], times density * velocity * h^2
  double pressure_jump = 0;  ///< CIP on [grad p], times h^3 / phi
  double divergence = 0;     ///< CIP on [div u], times phi * h
  double ghost_viscous = 0;  ///< ghost penalty on [grad u] of cut parts, times viscosity * h
  double ghost_inertial = 0; ///< ghost penalty on [grad u] of cut parts, times density * h^3 / reference_time
  double ghost_pressure = 0; ///< ghost penalty on [grad p] of cut parts, times h^3 / phi
  double nitsche_viscous = 0;                              ///< penalty viscosity / h
  double nitsche_normal = 0;                               ///< penalty phi / h on the normal component
  double reference_velocity = 0;                           ///< cm/s
  double reference_time = 0;                               ///< s
  VelocityScale velocity_scale = VelocityScale::reference; ///< of velocity_jump
};

} // namespace undula::fom
