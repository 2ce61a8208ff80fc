// Distance of places to rigid bodies that move.
#pragma once

#include "fom/problem/skin_conditions.hpp"

namespace undula::fom {

/// Distance of a place to a rigid body, negative inside of its material, and its derivatives by the place.
template <int dim>
struct RigidGap {
  double distance = 0;                               ///< cm
  Point<dim> direction;                              ///< unit, out of the material: the gradient
  Eigen::Matrix<double, dim, dim> second_derivative; ///< 1/cm
  Point<dim> velocity;                               ///< of the material that is nearest, cm/s
};

/// Where a rigid body is at one instant, and how it moves.
template <int dim>
struct RigidPlacement {
  Point<dim> displacement = Point<dim>::Zero(), velocity = Point<dim>::Zero(); ///< cm, cm/s
  double angle = 0, rate = 0;                                                  ///< rad, rad/s
};

/// At time t; rates by differences over a small part of `dt` (s).
template <int dim>
RigidPlacement<dim> place_rigid(const RigidBody<dim>& body, double t, double dt);

template <int dim>
RigidGap<dim> gap_to_rigid(const RigidBody<dim>& body, const RigidPlacement<dim>& placement,
                           const Point<dim>& x);

} // namespace undula::fom
