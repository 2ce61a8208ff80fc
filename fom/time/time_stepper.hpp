// Semi-implicit time stepping of the monolithic system by BDF1 or BDF2.
#pragma once

#include <array>
#include <optional>

#include "fom/contact/wall_contact.hpp"
#include "fom/system/newton.hpp"
#include "fom/time/energy_terms.hpp"
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

  /// What is left over of every equation of that step: zero but in the rows of imposed unknowns, where it is
  /// the generalised force that imposes them. Natural order, complete on every rank. Collective.
  Eigen::VectorXd residual(const State& state) const;

  /// Terms of the step that ended in `state` (state.step >= 1) and left this `residual`.
  EnergyTerms energy(const State& state, const Eigen::VectorXd& residual) const;

  double dt() const { return dt_; }

  /// Linear solves of the last step: Newton's iterations with nonlinear solids, else 1.
  int iterations() const { return iterations_; }
  LinearSystem<dim>& system() { return system_; }

private:
  void impose(const State& state, std::array<double, 3> alpha, double t, Eigen::VectorXd& rhs) const;
  /// `solve` as a function of factors and right side, with the equation of the holder in its row.
  template <class Solve>
  Eigen::VectorXd solve_with_holder(const State& state, const std::array<double, 3>& alpha, double t,
                                    Eigen::VectorXd& rhs, Solve&& solve) const;

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

} // namespace undula::fom
