// Meshing bodies in space by tetrahedra: bodies of revolution, whole or a sector of them, and what a closed
// surface of triangles bounds.
#pragma once

#include <filesystem>
#include <functional>

#include "geometry/mesh/polygon_mesh.hpp"

namespace undula::geometry {

/// Target length of the edges around x, cm; positive.
using SpaceSizeField = std::function<double(const Point<3>&)>;

/// Most points of a mesh in space: about two million cells. A mesh of more is refused.
inline constexpr int most_space_points = 400000;

/// Boundary name of the two planes that end a sector.
inline constexpr const char* symmetry_name = "symmetry";

/// The body that `profile` sweeps, a polygon in the half-plane of (r, z) = (x, y) >= 0, as it turns about the
/// z axis: whole (360 degrees), or the sector between the half-planes at angle 0 (y = 0, x > 0) and at
/// `sector_degrees`. Delaunay refinement (CGAL, Mesh_3) keeps the circles of all corners, and the profile and
/// the axis in the planes of a sector, as edges; points of the boundary lie on the body's surfaces, which the
/// cells approach by chords. Boundary names: those of the profile, and "symmetry" for a sector; sides of the
/// profile on the axis bound nothing. The result depends on the input only. Inner lines and paths of the
/// profile are not kept. Throws InputError if the profile is no simple counter-clockwise polygon with one tag
/// per side, reaches beyond the axis, or the angle is not in (0, 360], or the mesh would have more than
/// `most_points`; NumericsError if refinement does not keep the boundary.
SimplexMesh<3> mesh_revolved(const TaggedPolygon& profile, double sector_degrees, const SpaceSizeField& size,
                             int most_points = most_space_points);

/// Boundary name of what a surface of triangles bounds.
inline constexpr const char* surface_name = "surface";

/// What the closed surface of an OFF or STL file bounds, by the same refinement. Its coordinates are
/// multiplied by `cm_per_unit`. Edges where it turns by more than 30 degrees are kept; elsewhere cells
/// approach it, points of the boundary on its triangles. Throws InputError if the file cannot be read, holds
/// other than triangles, or its surface is open, crosses itself, or has an edge with more than two triangles,
/// or the mesh would have more than `most_points`.
SimplexMesh<3> mesh_closed_surface(const std::filesystem::path& file, double cm_per_unit,
                                   const SpaceSizeField& size, int most_points = most_space_points);

} // namespace undula::geometry
