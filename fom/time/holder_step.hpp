// The equation of a driven holder (fom/actuator) in one time step.
#pragma once

#include <array>

#include "fom/problem/problem.hpp"
#include "fom/time/state.hpp"

namespace undula::fom {

/// With v the holder's velocity at the end of the step and F the force of the holder on solids and fluid,
///   F + by_velocity v = force,
/// linearised about a place: exact where the holder meets no stop in between.
struct HolderStep {
  double by_velocity = 0; ///< dyn s/cm
  double force = 0;       ///< dyn
};

/// Of the step of length `dt` to time t with the coefficients `alpha` from `state`, about the velocity
/// `about` (cm/s) at its end. `unknown` is one of the holder's.
HolderStep holder_step(const DrivenHolder& holder, const std::array<double, 3>& alpha, double dt, double t,
                       const State& state, int unknown, double about);

} // namespace undula::fom
