// Checks of a stated problem by its outlines: what cannot be meshed, or makes no sense whatever the mesh.
#pragma once

#include <string>

#include "fom/scene/scene.hpp"

namespace undula::fom {

/// Cells that the sizes of a stated problem ask for.
struct StatedWork {
  double fluid_cells = 0, solid_cells = 0;
};

/// Throws InputError naming the key and where it stands, for
///   - outlines that repeat a corner, cross themselves or are too narrow to be meshed, holes that are not
///     inside of the domain and apart from each other,
///   - radii below 0, and sides on the axis that are not its symmetry, in axisymmetric space,
///   - lines that leave their body,
///   - what check_outlines (outlined_problem.hpp) refuses,
///   - points that are not in the fluid, or not on their body,
///   - sizes that ask for more than `most_cells` cells.
/// Circles count as polygons of 720 corners. `scene_name` names the scene where a key has no line.
StatedWork check_statement_geometry(const Scene& scene, const std::string& scene_name);

} // namespace undula::fom
