// One interface to the levels of the model hierarchy: what a scene chooses by model.space is prepared,
// marched and drawn by the same calls.
#pragma once

#include <mpi.h>

#include <memory>
#include <variant>

#include "fom/levels/level_view.hpp"
#include "fom/levels/simulation.hpp"
#include "fom/thin_gap/thin_gap.hpp"

namespace undula::fom {

/// Finite elements, or thin gaps: everything of a scene that does not depend on the operating point.
using PreparedLevel = std::variant<std::unique_ptr<PreparedScene>, ThinGapModel>;

/// Prepares the level that the scene chooses. Phases as prepare_scene or prepare_thin_gap. Collective over
/// `comm`. Thin gaps are small: every rank prepares and marches the same, so that all of them hold the state.
PreparedLevel prepare_level(const Scene& scene, MPI_Comm comm, PhaseTimer& timer);

/// Number of unknowns of one time step.
int unknowns(const PreparedLevel& level);

/// Rest.
State initial_state(const PreparedLevel& level);

/// Marches from `state` at the operating point of `scene`, which may differ from that of the scene the level
/// was prepared from, to the end of the scene's last period; `on_step` after every step on every rank.
/// Collective; throws NumericsError on every rank, leaving `state` at the last good step.
void march(PreparedLevel& level, const Scene& scene, State& state, PhaseTimer& timer,
           const StepCallback& on_step);

/// What is written and drawn of the level that was prepared from `scene`; for one rank. `level` has to
/// outlive it.
LevelView view_level(const PreparedLevel& level, const Scene& scene);

} // namespace undula::fom
