// When a run of a scene steps and ends.
#pragma once

#include "fom/scene/scene.hpp"

namespace undula::fom {

/// Time step, s: one period / steps_per_period, or the one a general problem names.
double time_step(const Scene& scene);

/// Number of the step that a run of the scene ends with.
int last_step(const Scene& scene);

} // namespace undula::fom
