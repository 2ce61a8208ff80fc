// Semi-implicit time stepping of the monolithic system by BDF1 or BDF2.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "fom/contact/skin_forces.hpp"
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
  /// Loads on skins and contact pairs of the problem count from the start. `contact`: whether set_contact
  /// will be called.
  TimeStepper(const Discretisation<dim>& disc, const Operators<dim>& operators, TimeScheme scheme, double dt,
              int factor_every, PhaseTimer& timer, const NewtonSettings& newton = {},
              const ConvectionSettings& convection = {}, bool contact = false);

  /// One step. Nonlinear solids, a film of contact and a convecting velocity that is off are found in the
  /// same iterations, from the extrapolated velocities. Collective; throws NumericsError on every rank,
  /// leaving `state` at the last good step.
  void advance(State& state);

  /// The same to time t, which has to be one dt later; for steps that are parts of a regular one.
  void advance_to(double t, State& state);

  /// Contact in the following steps, first linearised about `placement` (solids' unknowns). It has
  /// to outlive its use. The operators stay as they are. Collective.
  void set_contact(const WallContact<dim>& contact, const Eigen::VectorXd& placement);

  /// What is left over of every equation of that step: zero but in the rows of imposed unknowns, where it is
  /// the generalised force that imposes them. Natural order, complete on every rank. Collective.
  Eigen::VectorXd residual(const State& state) const;

  /// Terms of the step that ended in `state` (state.step >= 1) and left this `residual`.
  EnergyTerms energy(const State& state, const Eigen::VectorXd& residual) const;

  double dt() const { return dt_; }

  /// Linear solves of the last step.
  int iterations() const { return iterations_; }
  /// Nodes of the skin in the film of contact, the most of the last step's iterations.
  int contact_nodes() const { return contact_nodes_; }
  /// By contact pair of the problem, of the last step.
  const std::vector<PairReport<dim>>& contact_reports() const { return skin_there_.reports; }
  /// Distance of the extrapolated velocity from that of the last step, as ConvectionSettings::tolerance.
  double convection_error() const { return convection_error_; }
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
  Eigen::VectorXd loads(double t) const;
  void linearise_contact(const Eigen::VectorXd& placement);
  void linearise_skin(const SkinMotion<dim>& motion);
  /// Contact and loads on skins, stiffness on the first rank alone; about the same place as the matrix.
  void add_to_system();
  std::string missed_on_skin(const Eigen::VectorXd& d, const Eigen::VectorXd& v, double t, double rate);
  bool adds_contact() const { return contact_ && operators_.rank == 0; }
  /// What of convection and contact does not hold for the answer `x`, which displaces the solids to `d`.
  std::string missed(const Eigen::VectorXd& x, const Eigen::VectorXd& d, double t, double rate);
  double distance_by_energy(const Eigen::VectorXd& x, const Eigen::VectorXd& y) const;

  ConvectionSettings convection_;
  int iterations_ = 0, contact_nodes_ = 0;
  double convection_error_ = 0;
  LinearSystem<dim> system_;

  const WallContact<dim>* contact_with_ = nullptr;
  std::optional<ContactForce> contact_; ///< the same on every rank; the first adds it to sums over ranks
  Eigen::VectorXd contact_about_;       ///< where it is linearised, solids' unknowns
  Eigen::VectorXd contact_next_;        ///< where it is linearised next
  std::optional<SkinForces<dim>> skin_; ///< where the problem has any
  Eigen::VectorXd skin_load_;           ///< linearised force: load - stiffness * d
  SkinResponse<dim> skin_here_;         ///< where it is linearised
  SkinResponse<dim> skin_there_;        ///< where the last iteration ended
  SparseMatrix added_;                  ///< stiffness of walls and skins
  std::array<double, 3> alpha_{};       ///< of the last step
  Eigen::VectorXd older_x_, older_d_;   ///< levels n-1 of the last step, for the energy terms
  Eigen::VectorXd convecting_;          ///< velocity that convects in the last step
};

} // namespace undula::fom
