// One operating point of one scene, from rest (or a checkpoint) over its periods.
#pragma once

#include <functional>
#include <memory>

#include "fom/levels/scene_problem.hpp"
#include "fom/output/observables.hpp"
#include "fom/scene/scene.hpp"

namespace undula::fom {

/// Everything of a scene that does not depend on the operating point: meshes, cut, operators. Operating
/// points of a campaign share it.
struct PreparedScene {
  Discretisation<2> disc;
  Operators<2> operators;
  ObservationPlan<2> observation;
};

/// Number of membrane probes in envelopes.
inline constexpr int membrane_probe_count = 61;

/// Phases "mesh", "cut", "assemble". Collective over `comm`.
std::unique_ptr<PreparedScene> prepare_scene(const Scene& scene, MPI_Comm comm, PhaseTimer& timer);

/// Points the conditions of a prepared scene to another operating point (and ramp) of the same scene.
void set_operating_point(PreparedScene& prepared, const Scene& scene);

/// Called after every step on every rank.
using StepCallback = std::function<void(const State&, const Observation&)>;

/// Marches from `state` to the end of the scene's last period. Where the fluid's domain moves, discretisation
/// and operators in `prepared` follow the state. Throws NumericsError on every rank, leaving `state` at the
/// last good step. Phases "assemble", "factor", "solve", "observe".
void march(PreparedScene& prepared, const Scene& scene, State& state, PhaseTimer& timer,
           const StepCallback& on_step);

} // namespace undula::fom
