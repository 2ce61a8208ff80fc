// The parts of a step's residual that are not constant operators. Shared by the step, its energy and the
// steady state.
#pragma once

#include "fom/system/operators.hpp"

namespace undula::fom {

/// Loads that do not depend on the state: openings and body forces, complete on every rank.
template <int dim>
Eigen::VectorXd loads_at(const Discretisation<dim>& disc, const Operators<dim>& operators, double t) {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(disc.unknowns());
  bool has_body_force = static_cast<bool>(disc.problem.body_force);
  for (const auto& body : disc.problem.solids) has_body_force = has_body_force || body.body_force;
  if (has_body_force) {
    load = body_force_load(disc, Share{&operators.ownership.owner, operators.rank}, t);
    sum_over_ranks(operators.comm, load);
  }
  for (const auto& [name, functional] : operators.openings) {
    const auto& pressure = disc.problem.boundary.at(name).pressure;
    if (pressure) load -= pressure(t) * functional;
  }
  return load;
}

/// This rank's share of convection(b) x; nothing where has_convection says so.
template <int dim>
Eigen::VectorXd convection_of(const Discretisation<dim>& disc, const Operators<dim>& operators,
                              const Eigen::VectorXd& b, const Eigen::VectorXd& x) {
  Eigen::VectorXd convection = Eigen::VectorXd::Zero(x.size());
  if (has_convection(disc))
    visit_convection(disc, operators, b,
                     [&](int row, int column, double value) { convection[row] += value * x[column]; });
  return convection;
}

/// This rank's share of the kinetic power (b x, x) through openings. The rest of the convection does no work
/// on a domain at rest; where the domain moves it is part of the growth of the kinetic energy.
template <int dim>
double carried_power(const Discretisation<dim>& disc, const Operators<dim>& operators,
                     const Eigen::VectorXd& b, const Eigen::VectorXd& x) {
  double power = 0;
  visit_opening_convection(disc, operators, b,
                           [&](int row, int column, double value) { power += x[row] * value * x[column]; });
  return power;
}

/// This rank's share of the penalty on velocity jumps that the local velocity scales, times x.
template <int dim>
Eigen::VectorXd jumps_of(const Discretisation<dim>& disc, const Operators<dim>& operators,
                         const Eigen::VectorXd& b, const Eigen::VectorXd& x) {
  Eigen::VectorXd jumps = Eigen::VectorXd::Zero(x.size());
  visit_velocity_jumps(disc, operators.velocity_jumps, b,
                       [&](int row, int column, double value) { jumps[row] += value * x[column]; });
  return jumps;
}

template <int dim>
double imposed_fluid_value(const ConstrainedUnknown<dim>& constrained, double t) {
  if (!constrained.condition || !constrained.condition->velocity) return 0.0;
  return constrained.condition->velocity(constrained.position, t)[constrained.component];
}

} // namespace undula::fom
