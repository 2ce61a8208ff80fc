#include "fom/levels/scene_problem.hpp"

#include "fom/machines/wave_pump/pump_problem.hpp"
#include "fom/scene/general_problem.hpp"

namespace undula::fom {

FsiProblem<2> scene_problem(const Scene& scene) {
  return scene.problem.general ? general_problem(scene) : pump_problem(scene);
}

} // namespace undula::fom
