// Import of Gmsh meshes for users with CAD.
#pragma once

#include <filesystem>

#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::geometry {

/// A mesh read from a file and what had to be changed.
template <int dim>
struct ImportedMesh {
  SimplexMesh<dim> mesh;
  int reoriented_cells = 0; ///< cells that were inverted in the file and have been turned round
};

/// Reads a Gmsh file (MSH 2.2 or 4.1, ASCII) of linear simplices; its coordinates are multiplied by
/// `cm_per_unit`. Cells are all triangles (dim = 2, in the plane z = 0) or all tetrahedra (dim = 3). The
/// physical groups of dimension dim
/// - 1 become the boundary names; facets of groups inside the mesh and elements of lower dimension are left
/// out, as are nodes without a cell. Throws InputError, with file and line, for a missing, truncated, binary
/// or foreign file, elements that are not linear simplices, coordinates beyond 1e5 cm, flat cells, cells that
/// lie over one another, and boundary facets without a named physical group or in two of them.
template <int dim>
ImportedMesh<dim> import_gmsh(const std::filesystem::path& file, double cm_per_unit = 1);

} // namespace undula::geometry
