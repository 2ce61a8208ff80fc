#include "fom/levels/march.hpp"

#include "fom/scene/scene_time.hpp"

namespace undula::fom {

void march_to(Marcher& marcher, int last, State& state, const StepCallback& on_step) {
  while (state.step < last) {
    const Observation seen = marcher.advance(state);
    if (on_step) on_step(state, seen);
  }
}

void march(MarchingLevel& level, const Scene& scene, State& state, PhaseTimer& timer,
           const StepCallback& on_step, const StopCondition& ends) {
  const auto marcher = level.start(scene, state, timer);
  while (state.step < last_step(scene) && !(ends && ends(state)))
    march_to(*marcher, state.step + 1, state, on_step);
}

} // namespace undula::fom
