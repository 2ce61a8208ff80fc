// Summary of the size and the shape of a mesh.
#pragma once

#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::geometry {

/// Size and shape of a triangular mesh.
struct MeshQuality {
  int cells = 0;
  int points = 0;
  double min_angle = 0;     ///< degrees
  double max_angle = 0;     ///< degrees
  double shortest_edge = 0; ///< cm
  double longest_edge = 0;  ///< cm
  double area = 0;          ///< cm^2, without any factor r
};

/// All zero for a mesh without cells.
MeshQuality mesh_quality(const SimplexMesh<2>& mesh);

/// Size and shape of a mesh of tetrahedra.
struct TetrahedraQuality {
  int cells = 0;
  int points = 0;
  double min_angle = 0; ///< between two facets of a cell, degrees
  double max_angle = 0; ///< degrees
  double min_shape =
      0; ///< three times the inner over the outer radius: 1 for a regular cell, 0 for a flat one
  double shortest_edge = 0; ///< cm
  double longest_edge = 0;  ///< cm
  double volume = 0;        ///< cm^3
};

/// All zero for a mesh without cells.
TetrahedraQuality mesh_quality(const SimplexMesh<3>& mesh);

} // namespace undula::geometry
