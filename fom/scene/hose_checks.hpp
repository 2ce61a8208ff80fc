// Scenes of a peristaltic pump: the track that their keys state, and what contradicts itself.
#pragma once

#include <string>

#include "fom/scene/scene.hpp"
#include "geometry/hose/roller_track.hpp"

namespace undula::fom {

/// Hose, rollers and track of a scene.
geometry::RollerTrack roller_track(const Scene& scene);

/// Throws InputError for a level that knows no hose, for keys that it has no use for, and for a geometry that
/// cannot be: rollers that do not fit, places that overlap, ends that are squeezed. `where` names the scene.
void check_peristaltic_pump(const Scene& scene, const std::string& where);

} // namespace undula::fom
