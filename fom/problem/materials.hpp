// Fluids and solids, and the laws of solids. Plain data in cgs units.
#pragma once

namespace undula::fom {

enum class SolidModel {
  linear,
  von_karman,             ///< of a plate: stretching by moderate slopes (thin gap)
  saint_venant_kirchhoff, ///< the linear law in the Green-Lagrange strain: large rotations, small strains
  neo_hookean,            ///< compressible; large strains
};

struct FluidProperties {
  double density = 0;   ///< g/cm^3
  double viscosity = 0; ///< g/(cm s)
};

struct SolidProperties {
  double density = 0;      ///< g/cm^3
  double young = 0;        ///< dyn/cm^2
  double poisson = 0;      ///< -
  double damping_time = 0; ///< Kelvin-Voigt: stress = C (strain + damping_time * strain rate), s
  /// Rayleigh: force = mass_damping * mass * velocity + stiffness_damping * (stiffness at rest) * velocity.
  /// For the linear law the second is Kelvin-Voigt itself; for the others it resists rigid rotation, which
  /// Kelvin-Voigt by the rate of the Green-Lagrange strain does not.
  double mass_damping = 0;      ///< 1/s
  double stiffness_damping = 0; ///< s
};

} // namespace undula::fom
