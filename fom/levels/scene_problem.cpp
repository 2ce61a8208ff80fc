#include "fom/levels/scene_problem.hpp"

#include <cmath>

#include "fom/machines/wave_pump/pump_problem.hpp"
#include "fom/scene/general_problem.hpp"
#include "rom/base/error.hpp"

namespace undula::fom {

FsiProblem<2> scene_problem(const Scene& scene) {
  return scene.problem.general ? general_problem(scene) : pump_problem(scene);
}

void require_pump(const Scene& scene, const std::string& command) {
  if (!scene.problem.general) return;
  throw InputError(command + " needs a scene of a pump", "a scene with [domain] or [body.NAME]",
                   "a scene with \"geometry.profile\" or meshes; undula solve takes any scene",
                   scene.file.string());
}

FsiProblem<2> problem_without_meshes(const Scene& scene) {
  FsiProblem<2> problem;
  problem.space = scene.space;
  problem.flow = scene.flow;
  problem.fluid = scene.fluid;
  problem.stabilisation = scene.stabilisation;
  problem.slip_length = scene.interface == Interface::slip ? scene.contact.slip : 0.0;
  return problem;
}

std::vector<RefinementBox<2>> refinement_boxes(const ProblemStatement& problem) {
  std::vector<RefinementBox<2>> boxes;
  for (const auto& [name, box] : problem.refinements)
    boxes.push_back({{box.box[0][0], box.box[0][1]}, {box.box[1][0], box.box[1][1]}, box.size});
  return boxes;
}

double time_step(const Scene& scene) {
  if (scene.problem.general) return scene.time.step;
  return 1.0 / (scene.operating_point.frequency * scene.time.steps_per_period);
}

int last_step(const Scene& scene) {
  if (scene.problem.general) return static_cast<int>(std::lround(scene.time.end / scene.time.step));
  return scene.time.periods * scene.time.steps_per_period;
}

} // namespace undula::fom
