// What about the geometry of a pump makes no sense, from a profile or from imported meshes.
#pragma once

#include <string>
#include <vector>

#include "fom/fom.hpp"
#include "fom/scene/scene.hpp"
#include "geometry/mesh/simplex_mesh.hpp"
#include "geometry/wave_pump/clearance.hpp"
#include "geometry/wave_pump/profile.hpp"

namespace undula::fom {

/// Length of one unit of the scene's imported meshes, cm.
double mesh_unit_length(const Scene& scene);

/// Throws InputError where the motion would be imposed on more than the membrane from r = `inner` to `outer`
/// (cm), or on nothing of it; `what` says where these radii come from.
void check_clamp_radius(const Scene& scene, double inner, double outer, const std::string& what);

/// Gives the membrane of `profile` the corner radii that the scene states. Throws InputError for radii that
/// do not fit.
void round_corners(const Scene& scene, PumpProfile& profile);

/// Cells that the sizes of a pump made from a profile ask for. Throws InputError, naming the key that asks
/// for most of them, beyond `most_cells`.
struct PumpWork {
  double fluid_cells = 0, solid_cells = 0;
};
PumpWork check_pump_work(const Scene& scene, const PumpProfile& profile);

/// Throws InputError for imported meshes with negative radii, with a boundary on the axis that is not "axis"
/// or the other way round, without "inlet" or "outlet", and for what check_outlines refuses. The first solid
/// is the membrane.
void check_imported_meshes(const Scene& scene, const SimplexMesh<2>& background,
                           const std::vector<SimplexMesh<2>>& solids);

/// Sentences about materials that a profile states otherwise than the scene, which counts.
std::vector<std::string> profile_differences(const Scene& scene);

} // namespace undula::fom
