// What finite elements need of a scene before they march.
#pragma once

#include <mpi.h>

#include <memory>

#include "fom/output/observables.hpp"
#include "fom/scene/scene.hpp"
#include "rom/base/phase_timer.hpp"

namespace undula::fom {

/// Everything of a scene that does not depend on the operating point: meshes, cut, operators. Operating
/// points of a campaign share it. Where the fluid's domain moves, a march replaces discretisation and
/// operators by those of its state.
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

} // namespace undula::fom
