#include "fom/levels/simulation.hpp"

#include "fom/coupling/moving_stepper.hpp"
#include "fom/levels/scene_problem.hpp"
#include "fom/machines/wave_pump/pump_problem.hpp"

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
  if (general) prepared->observation.general = plan_general_observables(prepared->disc, scene);
  return prepared;
}

void set_operating_point(PreparedScene& prepared, const Scene& scene) {
  if (scene.problem.general) return; // its conditions are expressions of its own
  auto& problem = prepared.disc.problem;
  problem.boundary.at(outlet_name).pressure = [scene](double t) { return outlet_pressure(scene, t); };
  for (auto& body : problem.solids)
    body.imposed_displacement = [scene](const Point<2>&, double t) {
      return Point<2>(0.0, holder_displacement(scene, t));
    };
}

namespace {

/// Steps and observes until the scene's last step. `stepper` advances a state; `last_step` gives the
/// TimeStepper of the step that ended, `motion` what moved in it.
template <class Stepper, class LastStep, class Motion>
void step_and_observe(PreparedScene& prepared, int last, State& state, PhaseTimer& timer,
                      const StepCallback& on_step, Stepper& stepper, const LastStep& last_step,
                      const Motion& motion) {
  while (state.step < last) {
    stepper.advance(state);
    Observation seen;
    {
      const auto scope = timer.measure("observe");
      seen = observe(prepared.disc, prepared.operators, last_step(), prepared.observation, state);
      seen.motion = motion();
    }
    on_step(state, seen);
  }
}

} // namespace

void march(PreparedScene& prepared, const Scene& scene, State& state, PhaseTimer& timer,
           const StepCallback& on_step) {
  const int last = last_step(scene);
  if (scene.coupling == Coupling::fixed) {
    TimeStepper<2> stepper(prepared.disc, prepared.operators, scene.time.scheme, time_step(scene),
                           scene.time.factor_every, timer, scene.time.newton);
    step_and_observe(
        prepared, last, state, timer, on_step, stepper, [&]() -> const TimeStepper<2>& { return stepper; },
        [] { return MotionReport(); });
    return;
  }
  MovingStepper<2> stepper(prepared.disc, prepared.operators, scene.coupling, scene.time, scene.contact,
                           time_step(scene), timer, state);
  step_and_observe(
      prepared, last, state, timer, on_step, stepper,
      [&]() -> const TimeStepper<2>& { return stepper.last_step(); }, [&] { return stepper.report(); });
}

} // namespace undula::fom
