// From a scene to its fluid-structure problem.
#pragma once

#include <string>
#include <vector>

#include "fom/fom.hpp"
#include "fom/problem/problem.hpp"
#include "fom/scene/scene.hpp"
#include "geometry/mesh/refinement_box.hpp"

namespace undula::fom {

/// Meshes and conditions of a finite-element scene: of the pump (pump_problem), or as the scene states them
/// (general_problem). Throws InputError for what is wrong with them.
FsiProblem<2> scene_problem(const Scene& scene);

/// What every scene says alike of its problem: space, flow, fluid, interface and stabilisation.
FsiProblem<2> problem_without_meshes(const Scene& scene);

/// The boxes [refine.NAME] of a scene.
std::vector<RefinementBox<2>> refinement_boxes(const ProblemStatement& problem);

/// Time step, s: one period / steps_per_period, or the one a general problem names.
double time_step(const Scene& scene);

/// Throws InputError, naming the scene, where `command` needs a pump and the scene states a problem of its
/// own.
void require_pump(const Scene& scene, const std::string& command);

/// Number of the step that a run of the scene ends with.
int last_step(const Scene& scene);

} // namespace undula::fom
