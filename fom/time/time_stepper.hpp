// Semi-implicit time stepping of the monolithic system by BDF1 or BDF2.
#pragma once

#include <array>
#include <optional>

#include "fom/contact/wall_contact.hpp"
#include "fom/system/newton.hpp"
#include "fom/time/state.hpp"

namespace undula::fom {

/// Rest, but for the initial velocities of the solids.
template <int dim>
State initial_state(const Discretisation<dim>& disc);

/// (alpha_0 y^{n+1} + alpha_1 y^n + alpha_2 y^{n-1}) / dt approximates dy/dt at n+1.
/// The first step is BDF1. `ratio`: dt over the time between n-1 and n.
std::array<double, 3> bdf_coefficients(TimeScheme scheme, int step, double ratio = 1.0);

/// Displacement imposed on a node at time t, cm.
template <int dim>
Point<dim> imposed_displacement(const Discretisation<dim>& disc, const ImposedNode<dim>& node, double t);

/// What one step did, term by term; powers in erg/s, energies in erg. With T the scheme's time derivative,
///   holder + opening + body
///     = viscous + stabilisation + damping + contact + (mass T x, x) + (elastic force(d), x).
struct EnergyTerms {
  double holder = 0;        ///< power of the imposed motion on the solids (reaction times velocity)
  double boundary = 0;      ///< power of imposed fluid velocities
  double opening = 0;       ///< power of the pressures on the openings
  double body = 0;          ///< power of body forces
  double viscous = 0;       ///< dissipation of the fluid (with the consistent interface terms)
  double stabilisation = 0; ///< dissipation of the penalties
  double damping = 0;       ///< dissipation of the solids, Kelvin-Voigt and Rayleigh
  double contact = 0;       ///< power spent on closing the film of contact
  double carried = 0;       ///< kinetic energy carried through openings (static_pressure, traction)
  double kinetic = 0;       ///< energy, erg
  double elastic = 0;       ///< energy, erg
};

template <int dim>
class TimeStepper {
public:
  TimeStepper(const Discretisation<dim>& disc, const Operators<dim>& operators, TimeScheme scheme, double dt,
              int factor_every, PhaseTimer& timer, const NewtonSettings& newton = {});

  /// One step; with nonlinear solids by Newton's method from the extrapolated velocities. Collective; throws
  /// NumericsError on every rank, leaving `state` at the last good step.
  void advance(State& state);

  /// The same to time t, which has to be one dt later; for steps that are parts of a regular one.
  void advance_to(double t, State& state);

  /// The force of contact in the following steps, the same on every rank, in the place of an earlier one. The
  /// operators stay as they are. Collective.
  void set_contact(ContactForce contact);

  /// Terms of the step that ended in `state` (state.step >= 1).
  EnergyTerms energy(const State& state) const;

  /// What is left over of every equation of that step: zero but in the rows of imposed unknowns, where it is
  /// the generalised force that imposes them. Natural order, complete on every rank. Collective.
  Eigen::VectorXd residual(const State& state) const;

  double dt() const { return dt_; }

  /// Linear solves of the last step: Newton's iterations with nonlinear solids, else 1.
  int iterations() const { return iterations_; }
  LinearSystem<dim>& system() { return system_; }

private:
  void impose(const State& state, std::array<double, 3> alpha, double t, Eigen::VectorXd& rhs) const;

  const Discretisation<dim>& disc_;
  const Operators<dim>& operators_;
  TimeScheme scheme_;
  double dt_;
  PhaseTimer& timer_;
  NewtonSettings newton_;
  int iterations_ = 0;
  LinearSystem<dim> system_;
  Eigen::VectorXd loads(double t) const;

  std::optional<ContactForce> contact_; ///< its stiffness is part of the system's
  std::array<double, 3> alpha_{};       ///< of the last step
  Eigen::VectorXd older_x_, older_d_;   ///< levels n-1 of the last step, for the energy terms
  Eigen::VectorXd convecting_;          ///< extrapolated velocity of the last step
};

/// How a nonlinear solid is brought to its steady state: body forces, pressures and imposed values rise in
/// `load_steps` equal steps, Newton's method in each starts from the one before.
struct LoadPath {
  int load_steps = 1;
  NewtonSettings newton;
};

/// Steady state by Picard iteration from `x` until the relative change is below `tolerance`. Solids in vacuo
/// are at rest under their static loads (their unknowns are displacements here); solids in a fluid have to be
/// imposed throughout, else InputError. Returns the linear solves
/// taken. Throws NumericsError when `max_iterations` (or Newton's of a load step) do not suffice, leaving `x`
/// at the last load that was reached.
template <int dim>
int solve_steady(const Discretisation<dim>& disc, const Operators<dim>& operators, double tolerance,
                 int max_iterations, PhaseTimer& timer, Eigen::VectorXd& x, const LoadPath& path = {});

/// TimeStepper::residual for a steady state, at time 0. Collective.
template <int dim>
Eigen::VectorXd steady_residual(const Discretisation<dim>& disc, const Operators<dim>& operators,
                                const Eigen::VectorXd& x);

} // namespace undula::fom
