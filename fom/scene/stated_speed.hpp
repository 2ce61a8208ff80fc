// The speed that the data of a scene lead to expect.
#pragma once

#include "fom/scene/scene.hpp"

namespace undula::fom {

/// Greatest speed (cm/s, two digits) among the velocities that a general problem states up to its end: on
/// boundaries, of held bodies and at the start; and the one that pressures of openings and forces on the
/// fluid (where nothing else drives: on bodies) could give: of a pressure difference dp over a domain of
/// length L the lesser of sqrt(2 dp / density) (Bernoulli) and dp L / (8 viscosity) (Poiseuille, a channel as
/// wide as long). 0 where nothing drives, without a fluid, and for pumps. A scale for StabilisationWeights,
/// not a bound: expressions are sampled, at instants without a rhythm that a period could fall into; where
/// they are not finite they do not count.
double stated_speed(const Scene& scene);

} // namespace undula::fom
