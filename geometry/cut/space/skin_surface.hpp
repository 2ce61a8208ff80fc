// The skin of solids in space: closed surfaces of triangles, and which of them touch each other.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::geometry {

/// A facet of a solid with fluid beyond it. Seen from the solid its points go round counter-clockwise: the
/// normal (b - a) x (c - a) points into the solid.
struct SkinTriangle {
  int solid = -1;
  int cell = -1;             ///< cell of the solid behind the triangle
  std::array<int, 3> points; ///< of the skin
  std::array<int, 3> edges;  ///< edge i joins the points i and i + 1
};

struct SkinEdge {
  std::array<int, 2> points;    ///< of the skin, ascending
  std::array<int, 2> triangles; ///< the first two
  bool pinched = false;         ///< belongs to more than two triangles
};

struct SkinSurface {
  std::vector<SolidCell> points; ///< solid, and point of its mesh
  std::vector<SkinTriangle> triangles;
  std::vector<SkinEdge> edges;
  std::vector<int> first_edge; ///< [point], [point + 1): range in edges_of_points
  std::vector<int> edges_of_points;
};

/// Does not depend on the coordinates of the points. Throws NumericsError if two cells lie on one side of a
/// facet (a folded mesh).
SkinSurface build_skin_surface(std::span<const SimplexMesh<3>> solids, std::span<const FacetTable<3>> facets);

/// Where the points of the skin are placed, cm.
std::vector<Point<3>> place_surface(const SkinSurface& skin, std::span<const SimplexMesh<3>> solids);

/// Triangles of which it is not certain that they share nothing with another one but points and edges of
/// their meshes, and those at pinched edges; ascending.
std::vector<int> touching_triangles(const SkinSurface& skin, std::span<const Point<3>> placed);

} // namespace undula::geometry
