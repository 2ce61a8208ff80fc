// The fluid-structure problem that a scene states by a domain, bodies and conditions (Scene::problem).
#pragma once

#include "fom/problem/problem.hpp"
#include "fom/scene/scene.hpp"

namespace undula::fom {

/// Meshes the domain and the bodies and turns expressions into functions. Solids are in the order of their
/// names. A domain without openings has its pressure pinned. Throws InputError, naming the section, for
/// shapes that cannot be meshed, free bodies without density or stiffness and sides whose condition they do
/// not fit.
FsiProblem<2> general_problem(const Scene& scene);

} // namespace undula::fom
