// From a scene to the fluid-structure problem of the pump.
#pragma once

#include <optional>

#include "fom/fom.hpp"
#include "fom/problem/problem.hpp"
#include "fom/scene/operating_point.hpp"
#include "fom/scene/scene.hpp"
#include "geometry/wave_pump/profile.hpp"

namespace undula::fom {

/// The profile of a scene that names one, with its gaps scaled as the scene says (scale_clearances). Throws
/// InputError for a missing or bad profile, for scales it does not bear, and for a clamp radius off the
/// membrane.
PumpProfile scene_profile(const Scene& scene);

/// The holder of a scene that drives it by a voltage; none where its motion is imposed.
std::optional<DrivenHolder> driven_holder(const Scene& scene);

/// Meshes (from the profile, or the Gmsh files of the scene) and conditions. Solid 0 is the membrane; the
/// others (magnet ring) move with the holder. Names of the openings: "inlet", "outlet"; every boundary other
/// than these and "axis" is a wall. Throws InputError for bad profiles or meshes (pump_checks.hpp), before
/// any mesh is made of sizes that ask for too many cells.
FsiProblem<2> pump_problem(const Scene& scene);

} // namespace undula::fom
