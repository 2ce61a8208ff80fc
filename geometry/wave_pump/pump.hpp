// Meshes of a pump: the background that fits the walls, and the solids that cut it.
#pragma once

#include <span>

#include "geometry/mesh/refinement_box.hpp"
#include "geometry/mesh/simplex_mesh.hpp"
#include "geometry/wave_pump/clearance.hpp"
#include "geometry/wave_pump/profile.hpp"

namespace undula::geometry {

/// Background mesh of the fluid domain; the solids are not cut out. Boundary names "housing", "stator",
/// "axis", "inlet", "outlet". Sizes by pump_size_field, and no larger than the boxes ask for. Throws
/// InputError when a size makes no sense.
SimplexMesh<2> pump_background(const PumpProfile& profile, const PumpMeshSizes& sizes,
                               std::span<const RefinementBox<2>> boxes = {});

/// Membrane at rest, at least two elements through its thickness, with a line of mesh edges at the clamp
/// radius. Boundary names "lower", "rim", "upper", "tip".
SimplexMesh<2> pump_membrane(const PumpProfile& profile, const PumpMeshSizes& sizes);

/// Section of the magnet ring. Boundary name "magnet".
SimplexMesh<2> pump_magnet(const PumpProfile& profile, const PumpMeshSizes& sizes);

} // namespace undula::geometry
