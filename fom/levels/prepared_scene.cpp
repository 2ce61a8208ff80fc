#include "fom/levels/prepared_scene.hpp"

#include <utility>

#include "fom/levels/scene_problem.hpp"
#include "fom/machines/wave_pump/pump_problem.hpp"
#include "fom/scene/operating_point.hpp"

namespace undula::fom {

std::unique_ptr<PreparedScene> prepare_scene(const Scene& scene, MPI_Comm comm, PhaseTimer& timer) {
  auto prepared = std::make_unique<PreparedScene>();
  FsiProblem<2> problem;
  {
    const auto scope = timer.measure("mesh");
    problem = scene_problem(scene);
  }
  {
    const auto scope = timer.measure("cut");
    prepared->disc = discretise(std::move(problem), CutOptions{});
  }
  prepared->operators = build_operators(prepared->disc, comm, timer);
  const bool general = scene.problem.general;
  prepared->observation = plan_observation(prepared->disc, general ? 0 : membrane_probe_count);
  if (!general) prepared->observation.blood = scene.blood;
  if (general) prepared->observation.general = plan_general_observables(prepared->disc, scene);
  return prepared;
}

void set_operating_point(PreparedScene& prepared, const Scene& scene) {
  if (scene.problem.general) return; // its conditions are expressions of its own
  auto& problem = prepared.disc.problem;
  problem.boundary.at(outlet_name).pressure = [scene](double t) { return outlet_pressure(scene, t); };
  problem.holder = driven_holder(scene);
  for (auto& body : problem.solids)
    body.imposed_displacement = [scene](const Point<2>&, double t) {
      return Point<2>(0.0, holder_displacement(scene, t));
    };
}

} // namespace undula::fom
