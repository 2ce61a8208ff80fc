// From a scene to the fluid-structure problem of the pump.
#pragma once

#include "fom/fom.hpp"
#include "fom/problem/problem.hpp"
#include "fom/scene/scene.hpp"
#include "geometry/wave_pump/profile.hpp"
#include "rom/base/smooth_ramp.hpp"

namespace undula::fom {

/// Imposed displacement of the holder, Phi ramp(t) sin(2 pi f t), cm.
double holder_displacement(const Scene& scene, double t);

/// Pressure at the outlet, head times ramp(t), dyn/cm^2; the inlet is at zero.
double outlet_pressure(const Scene& scene, double t);

/// The profile of a scene that names one, with its gaps scaled as the scene says (scale_clearances). Throws
/// InputError for a missing or bad profile, for scales it does not bear, and for a clamp radius off the
/// membrane.
PumpProfile scene_profile(const Scene& scene);

/// Meshes (from the profile, or the Gmsh files of the scene) and conditions. Solid 0 is the membrane; the
/// others (magnet ring) move with the holder. Names of the openings: "inlet", "outlet"; every boundary other
/// than these and "axis" is a wall. Throws InputError for bad profiles or meshes (pump_checks.hpp), before
/// any mesh is made of sizes that ask for too many cells.
FsiProblem<2> pump_problem(const Scene& scene);

/// Names of the openings, as keys of Operators::openings.
inline constexpr const char* inlet_name = "inlet";
inline constexpr const char* outlet_name = "outlet";

} // namespace undula::fom
