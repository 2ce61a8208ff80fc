// From a scene to its fluid-structure problem.
#pragma once

#include "fom/problem/problem.hpp"
#include "fom/scene/scene.hpp"

namespace undula::fom {

/// Meshes and conditions of a finite-element scene: of the pump (pump_problem), or as the scene states them
/// (general_problem). Throws InputError for what is wrong with them.
FsiProblem<2> scene_problem(const Scene& scene);

} // namespace undula::fom
