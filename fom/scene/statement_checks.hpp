// Checks of a general problem that involve several keys.
#pragma once

#include <set>
#include <string>

#include "fom/scene/scene.hpp"

namespace undula::fom {

/// Steps of a run are counted by integers, and no run has a hundred million of them.
inline constexpr int most_steps = 100'000'000;

/// Names of the boundaries of the fluid: sides of the domain and holes.
std::set<std::string> boundary_names(const ProblemStatement& problem);

/// Throws InputError for a box that is none, or that has no mesh to refine.
void check_refinements(const Scene& scene, const std::string& where);

/// Throws InputError naming the keys that contradict each other; `where` names the scene in the message.
void check_statement(const Scene& scene, const std::string& where);

} // namespace undula::fom
