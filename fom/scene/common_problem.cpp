#include "fom/scene/common_problem.hpp"

#include "fom/scene/scene_time.hpp"
#include "rom/base/error.hpp"

namespace undula::fom {

StabilisationWeights weights_in_force(const Scene& scene, double speed) {
  StabilisationWeights weights = scene.stabilisation;
  if (weights.reference_velocity == 0) weights.reference_velocity = speed;
  if (weights.reference_time == 0) weights.reference_time = time_step(scene);
  return weights;
}

FsiProblem<2> problem_without_meshes(const Scene& scene) {
  FsiProblem<2> problem;
  problem.space = scene.space;
  problem.flow = scene.flow;
  problem.fluid = scene.fluid;
  problem.velocity_order = scene.velocity_order;
  problem.slip_length = scene.interface == Interface::slip ? scene.contact.slip : 0.0;
  return problem;
}

std::vector<RefinementBox<2>> refinement_boxes(const ProblemStatement& problem) {
  std::vector<RefinementBox<2>> boxes;
  for (const auto& [name, box] : problem.refinements)
    boxes.push_back({{box.box[0][0], box.box[0][1]}, {box.box[1][0], box.box[1][1]}, box.size});
  return boxes;
}

void require_pump(const Scene& scene, const std::string& command) {
  if (!scene.problem.general) return;
  throw InputError(command + " needs a scene of a pump", "a scene with [domain] or [body.NAME]",
                   "a scene with \"geometry.profile\" or meshes; undula solve takes any scene",
                   scene.file.string());
}

void require_wave_pump(const Scene& scene, const std::string& command) {
  require_pump(scene, command);
  if (scene.machine == Machine::wave_pump) return;
  throw InputError(command + " needs a scene of a wave pump", "machine = \"peristaltic-pump\"",
                   "machine = \"wave-pump\"; undula solve, hq and study take any pump", scene.file.string());
}

} // namespace undula::fom
