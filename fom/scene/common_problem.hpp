// What every scene says alike of its problem, whether it describes a pump or states a problem of its own.
#pragma once

#include <string>
#include <vector>

#include "fom/problem/problem.hpp"
#include "fom/scene/scene.hpp"
#include "geometry/mesh/refinement_box.hpp"

namespace undula::fom {

/// The scene's weights of the stabilisation; a time of 0 is the time step, a velocity of 0 is `speed` (cm/s).
StabilisationWeights weights_in_force(const Scene& scene, double speed);

/// Space, flow, fluid and interface; neither meshes nor weights.
FsiProblem<2> problem_without_meshes(const Scene& scene);

/// The boxes [refine.NAME] of a scene.
std::vector<RefinementBox<2>> refinement_boxes(const ProblemStatement& problem);

/// Throws InputError, naming the scene, where `command` needs a pump and the scene states a problem of its
/// own.
void require_pump(const Scene& scene, const std::string& command);

/// The same where it needs a wave pump.
void require_wave_pump(const Scene& scene, const std::string& command);

} // namespace undula::fom
