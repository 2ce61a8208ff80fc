// Loads, rigid bodies and contact pairs as a scene states them.
#pragma once

#include <string>

#include "fom/problem/problem.hpp"
#include "fom/scene/scene.hpp"

namespace undula::fom {

/// Refuses (InputError) what of [load.NAME], [rigid.NAME] and [pair.NAME] makes no sense whatever the mesh.
/// `where`: the scene's name for messages.
void check_skin_statement(const Scene& scene, const std::string& where);

/// Adds them to a problem whose solids are made. Stiffness and depth that a pair leaves out are derived from
/// the bodies, as the scene reference says.
void add_skin_conditions(const Scene& scene, FsiProblem<2>& problem);

/// Smallest element size that is stated of a body, cm.
double smallest_size(const ProblemStatement& problem, const std::string& body);

} // namespace undula::fom
