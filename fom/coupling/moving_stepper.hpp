// Time stepping of a fluid's domain that follows the solids: place the geometry, then one step of
// TimeStepper.
//
//   explicit  cut anew where the solids are extrapolated to be, fields transferred to the new unknowns
//   implicit  the same in turns, until the solids end where they were placed
//   mapped    one cut at rest; the ALE map follows the extrapolated solids, in turns where a film of contact
//             ends a fifth off the one that was placed
#pragma once

#include <optional>

#include "fom/coupling/field_transfer.hpp"
#include "fom/coupling/motion_report.hpp"
#include "fom/mapping/domain_extension.hpp"
#include "fom/mapping/unfolding.hpp"
#include "fom/time/time_stepper.hpp"

namespace undula::fom {

template <int dim>
class MovingStepper {
public:
  /// Brings `disc` and `operators` to where `state` has its geometry. Both are replaced at every step and
  /// have to outlive the stepper. Throws InputError if the state does not fit that geometry.
  MovingStepper(Discretisation<dim>& disc, Operators<dim>& operators, Coupling coupling,
                const SteppingSettings& settings, const ContactSettings& contact, double dt,
                PhaseTimer& timer, const State& state);

  /// One regular step, in parts where the numerics or the geometry fail at the whole one. Phases "cut",
  /// "transfer" besides those of TimeStepper. Collective; throws NumericsError on every rank, leaving
  /// `state`, disc and operators at the last good step.
  void advance(State& state);

  /// The last part of the last step: energies and reactions.
  const TimeStepper<dim>& last_step() const { return *stepper_; }
  const MotionReport& report() const { return report_; }

private:
  void advance_part(double t, double dt, State& state);
  Eigen::VectorXd extrapolated_placement(const State& state, double t, double dt) const;
  void place_cut(const Eigen::VectorXd& placement, const State& before, Discretisation<dim>& origin,
                 State& state);
  void place_map(const Eigen::VectorXd& placement, double dt, const State& before, State& state);
  std::vector<Point<dim>> unfolded(const std::vector<Point<dim>>& target, const Eigen::VectorXd& last,
                                   const State& before);
  /// Whether the solids end near enough to where they were placed.
  bool settled(const Eigen::VectorXd& placed, const Eigen::VectorXd& computed) const;
  void restore(const State& state);
  void solve_placed(const Eigen::VectorXd& placement, double t, double dt, State& state);

  Discretisation<dim>& disc_;
  Operators<dim>& operators_;
  Coupling coupling_;
  SteppingSettings settings_;
  double dt_;
  PhaseTimer& timer_;
  std::optional<WallContact<dim>> contact_;
  std::optional<DomainExtension<dim>> extension_; ///< mapped
  std::optional<Unfolding<dim>> unfolding_;       ///< mapped
  CutOptions cut_options_;
  std::optional<TimeStepper<dim>> stepper_;
  MotionReport report_;
};

} // namespace undula::fom
