// Meshing a polygon with a tagged boundary by Delaunay refinement.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::geometry {

/// A hole of a polygon: a simple polygon in either direction, strictly inside and apart from other holes.
struct TaggedHole {
  std::vector<Point<2>> points; ///< cm
  int tag = 0;                  ///< of all its edges
};

/// A closed simple polygon, counter-clockwise. All its points become mesh points.
struct TaggedPolygon {
  std::vector<Point<2>> points;                ///< cm
  std::vector<int> tags;                       ///< tag of the edge from point i to point i + 1 (cyclic)
  std::vector<std::string> names;              ///< name of each tag
  std::vector<std::array<int, 2>> inner_lines; ///< pairs of point indices: lines that the mesh keeps as edges
  std::vector<TaggedHole> holes;
  std::vector<std::vector<Point<2>>>
      inner_paths; ///< polygonal lines in the inside that the mesh keeps as edges
};

/// Target length of the edges around x, cm; positive.
using SizeField = std::function<double(const Point<2>&)>;

/// Triangulates `polygon` by Delaunay refinement (Ruppert, Shewchuk): no edge longer than the size at its
/// cell's centroid, angles above `min_angle` (degrees; up to 20.7 proven, about 30 in practice) but where the
/// polygon itself is sharper. The result depends on the input only; points follow a Hilbert curve and cells
/// their first point, so neighbours are close in memory. Throws InputError when the polygon is not simple and
/// counter-clockwise, a hole is not simple or not inside, one of them is narrower somewhere than
/// `narrowest_part` of the extent, or the mesh would have more than `most_cells` cells, NumericsError when
/// refinement does not keep an edge of the polygon.
SimplexMesh<2> mesh_polygon(const TaggedPolygon& polygon, const SizeField& size, double min_angle);

} // namespace undula::geometry
