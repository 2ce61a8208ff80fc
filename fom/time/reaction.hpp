// Forces between the fluid and its boundaries or solids, by the residual of the discrete equations.
//
// The sum of the residual over the nodes of a boundary is the force that holds the discrete flow there. Its
// error has twice the order of an integral of the discrete stress (Giles, Larson, Levenstam & Suli 1997; John
// 2004).
#pragma once

#include <string>

#include "fom/time/time_stepper.hpp"

namespace undula::fom {

/// Force of the fluid on the boundary `name`, where the velocity has to be imposed, from the residual of the
/// step that ended in `state` (TimeStepper::residual) or of a steady state (steady_residual). A node shared
/// with another boundary counts wholly for `name`. dyn (per cm of depth in plane space; in axisymmetric space
/// only the axial component is a force, the radial one is the integral of the radial traction).
template <int dim>
Point<dim> force_on_boundary(const Discretisation<dim>& disc, const Eigen::VectorXd& residual,
                             const std::string& name);

/// Force of the fluid on solid `solid`, its own inertia and elasticity left out; units as above. `velocities`
/// holds the unknowns of a time step, or of a steady state of solids that do not move. Collective.
template <int dim>
Point<dim> force_on_solid(const Discretisation<dim>& disc, const Operators<dim>& operators,
                          const Eigen::VectorXd& velocities, int solid);

} // namespace undula::fom
