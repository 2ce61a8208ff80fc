// The content of a Gmsh file as it stands there, before it becomes a mesh.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::geometry {

/// One element of a Gmsh file.
struct GmshElement {
  int type = 0;              ///< 1 segment, 2 triangle, 4 tetrahedron, 15 point
  std::vector<long> nodes;   ///< node tags
  std::vector<int> physical; ///< tags of its physical groups
  int line = 0;              ///< in the file
};

/// What Undula uses of a Gmsh file.
struct GmshFile {
  std::map<std::pair<int, int>, std::string> physical_names; ///< (dimension, tag) -> name
  std::map<long, Point<3>> nodes;                            ///< node tag -> coordinates
  std::vector<GmshElement> elements;
};

/// Dimension of a linear simplex type of Gmsh, -1 for every other type.
int gmsh_simplex_dimension(int type);

/// Reads MSH 2.2 or 4.1 (ASCII). Throws InputError with file and line for a missing, truncated, binary or
/// foreign file and for elements that are not linear simplices.
GmshFile read_gmsh_file(const std::filesystem::path& file);

} // namespace undula::geometry
