// Powers and energies of one step.
#pragma once

#include <limits>

namespace undula::fom {

/// What one step did, term by term; powers in erg/s, energies in erg. With T the scheme's time derivative,
///   holder + opening + body
///     = viscous + stabilisation + damping + contact + (mass T x, x) + (elastic force(d), x).
struct EnergyTerms {
  double holder =
      0; ///< power of the holder, or of another imposed motion, on the solids (reaction times velocity)
  double boundary = 0;      ///< power of imposed fluid velocities
  double opening = 0;       ///< power of the pressures on the openings
  double body = 0;          ///< power of body forces
  double viscous = 0;       ///< dissipation of the fluid (with the consistent interface terms)
  double stabilisation = 0; ///< dissipation of the penalties
  double damping = 0;       ///< dissipation of the solids, Kelvin-Voigt and Rayleigh
  /// What the time scheme takes by itself: with equal steps BDF2 loses |x - 2 x' + x''|^2 / (4 dt) of kinetic
  /// energy, BDF1 |x - x'|^2 / (2 dt), in the norm of the mass, on average over a period (Dahlquist's
  /// G-stability); of linear solids' elastic energy likewise. What a map changes of the mass is left out.
  double scheme = 0;
  double contact = 0; ///< power spent on closing the film of contact
  double carried = 0; ///< kinetic energy carried through openings (static_pressure, traction)
  double kinetic = 0; ///< energy, erg
  double elastic = 0; ///< energy, erg
};

inline constexpr double unknown_power = std::numeric_limits<double>::quiet_NaN();
inline constexpr EnergyTerms unknown_energy{unknown_power, unknown_power, unknown_power, unknown_power,
                                            unknown_power, unknown_power, unknown_power, unknown_power,
                                            unknown_power, unknown_power, unknown_power, unknown_power};

} // namespace undula::fom
