// Steady states: of flows by Picard's iteration, of solids by Newton's method along a path of loads.
#pragma once

#include "fom/system/newton.hpp"

namespace undula::fom {

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
