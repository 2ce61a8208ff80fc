#include "fom/scene/scene_time.hpp"

#include <cmath>

namespace undula::fom {

double time_step(const Scene& scene) {
  if (scene.problem.general) return scene.time.step;
  return 1.0 / (scene.operating_point.frequency * scene.time.steps_per_period);
}

int last_step(const Scene& scene) {
  if (scene.problem.general) return static_cast<int>(std::lround(scene.time.end / scene.time.step));
  return scene.time.periods * scene.time.steps_per_period;
}

} // namespace undula::fom
