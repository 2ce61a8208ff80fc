// The one loop over time steps.
#pragma once

#include <functional>

#include "fom/levels/level.hpp"

namespace undula::fom {

/// Called after every step on every rank.
using StepCallback = std::function<void(const State&, const Observation&)>;

/// Asked after every step on every rank, with the same answer: whether the march ends here.
using StopCondition = std::function<bool(const State&)>;

/// Advances `state` until it has reached step `last`. Throws NumericsError on every rank, leaving `state` at
/// the last good step. Collective.
void march_to(Marcher& marcher, int last, State& state, const StepCallback& on_step);

/// From `state` to the last step of the scene, or until `ends` says so. Collective.
void march(MarchingLevel& level, const Scene& scene, State& state, PhaseTimer& timer,
           const StepCallback& on_step, const StopCondition& ends = {});

} // namespace undula::fom
