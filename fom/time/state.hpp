// The state of a model at an instant, with what a scheme of second order needs of the one before.
#pragma once

#include <Eigen/Core>
#include <array>

namespace undula::fom {

/// Time levels in use: x and d at the current step [0] and the one before [1]. Natural order, complete on
/// every rank. cm/s (velocities), dyn/cm^2 (pressure), cm (displacement, at the places of the solid
/// velocities).
struct State {
  int step = 0;
  double time = 0;      ///< s
  double last_step = 0; ///< s between the two levels; 0: one regular step
  std::array<Eigen::VectorXd, 2> x;
  std::array<Eigen::VectorXd, 2> d;
  /// Displacement of the solids at which the fluid's domain was cut, or mapped: cm, the solids' unknowns
  /// only. Empty: at rest.
  Eigen::VectorXd placement;
  std::array<Eigen::VectorXd, 2> map; ///< cm, DomainMap::displacement at both levels; empty: identity
};

} // namespace undula::fom
