// The full-order models: finite elements on a cut mesh, and thin gaps.
//
//   problem/    what a discretisation needs: materials, conditions, settings
//   space/      unknowns on a cut          assembly/, materials/  weak forms, laws of solids
//   system/     matrix, solver, Newton     time/                  steps and their energy
//   coupling/, mapping/, contact/          how the fluid's domain follows the solids
//   thin_gap/, long_wave/  fast levels     levels/                one door to every level
//   scene/      from a file to settings    machines/              from a scene to the problem of a pump
//   output/     what is written of a run
//
// Folders of the first four lines know nothing of the others, fast levels included (.ci/check_includes).
#pragma once

namespace undula::geometry {}

namespace undula::fom {
using namespace geometry; // points, meshes and cuts go by their short names
}
