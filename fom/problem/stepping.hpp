// How a problem is stepped in time: scheme, Newton's method, how the fluid's domain follows the solids,
// contact.
#pragma once

namespace undula::fom {

enum class Coupling {
  fixed,     ///< the displacement does not move the fluid domain
  mapped,    ///< one cut at rest; the motion enters through the ALE map
  explicit_, ///< cut anew every step, where the solids are extrapolated to be
  implicit,  ///< fluid domain and displacement of the same instant: cut and solve in turns (thin gap: Newton)
};

/// The word for it in scenes and results.
const char* coupling_name(Coupling coupling);

/// Where the solids are expected at the end of a step.
enum class Extrapolation {
  first, ///< d + dt v
  second ///< 2 d - d_before, the second order with BDF2's velocities: d + dt (3 v - v_before) / 2
};

enum class TimeScheme { bdf1, bdf2 };

/// Newton's method for solids with a nonlinear law.
struct NewtonSettings {
  double tolerance = 1e-8; ///< of the balance of forces on the solids, relative to their internal forces
  int max_iterations = 20;
};

/// The velocity that convects. It is extrapolated from the steps before, and taken anew from the answer of
/// the step where that is off by more than `tolerance`.
struct ConvectionSettings {
  double tolerance =
      0; ///< |convecting - computed| over |computed|, by kinetic energy; 0: extrapolated always
};

/// How the fluid's domain follows the solids (couplings other than `fixed`).
struct MotionSettings {
  Extrapolation extrapolation = Extrapolation::second;
  double tolerance = 0;    ///< cm, implicit: largest difference between placed and computed displacement
  int max_iterations = 20; ///< implicit: turns of cut and solve in one step
  int max_halvings = 6;    ///< of the time step, where a step fails or solids would pass a wall
  double film_change = 0;  ///< largest change of a gap in the film, relative to the smaller, before a step is
                           ///< taken in parts, eight at most; 0: any
};

/// Contact of the displaced solids with walls: nodes of the skin closer than `film` are pushed off by
/// stiffness * (film / gap - 1).
struct ContactSettings {
  double film = 0;      ///< cm, thickness of the film that is kept; 0: no contact law
  double stiffness = 0; ///< dyn/cm^2
  double slip = 0;      ///< Navier slip length on the solids' skin, cm (Interface::slip)
};

/// What a step of the finite-element level needs to know.
struct SteppingSettings {
  TimeScheme scheme = TimeScheme::bdf2;
  int factor_every = 1; ///< most steps that share one factorisation; the rest is left to GMRES
  NewtonSettings newton;
  ConvectionSettings convection;
  MotionSettings motion;
};

} // namespace undula::fom
