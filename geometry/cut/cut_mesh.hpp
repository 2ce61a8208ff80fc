// A background mesh cut by solid meshes: the fluid part(s) of every element, what they touch, and how to
// integrate over them. Plain data; see cut.hpp for how it is made.
#pragma once

#include <span>

#include "geometry/mesh/quadrature.hpp"
#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::geometry {

/// One connected fluid part of one background element. An uncut fluid element has one part: itself.
/// An element wholly inside a solid has none.
struct FluidPart {
  int cell = -1;
  bool cut = false;         ///< false: the part is the whole element
  double measure = 0;       ///< cm^dim
  int quadrature_begin = 0; ///< range in CutMesh::volume_quadrature (empty for uncut parts)
  int quadrature_end = 0;
  int simplex_begin = 0; ///< range in CutMesh::simplices (empty for uncut parts)
  int simplex_end = 0;
};

/// Convex piece of the skin of a solid that bounds one fluid part (several may share part and solid cell).
template <int dim>
struct InterfacePiece {
  int part = -1;            ///< index into CutMesh::parts
  int solid = -1;           ///< which solid mesh
  int solid_cell = -1;      ///< cell of the solid mesh behind the piece
  Point<dim> normal;        ///< unit, out of the fluid, into the solid
  int quadrature_begin = 0; ///< range in CutMesh::interface_quadrature
  int quadrature_end = 0;
};

/// Two fluid parts of neighbouring elements that share a piece of positive measure of a background facet.
struct FacetConnection {
  int facet = -1; ///< index into CutMesh::facets.facets
  int part[2] = {-1, -1};
  double measure = 0; ///< of the shared piece, cm^(dim-1)
};

/// The piece of a boundary facet of the background mesh that a fluid part touches.
struct BoundaryPiece {
  int facet = -1;
  int part = -1;
  int tag = -1;
  int quadrature_begin = 0; ///< range in CutMesh::boundary_quadrature
  int quadrature_end = 0;
};

template <int dim>
struct CutMesh {
  SimplexMesh<dim> mesh;        ///< the background
  FacetTable<dim> facets;       ///< of the background
  std::vector<FluidPart> parts; ///< ordered by cell
  std::vector<int> cell_parts;  ///< [cell], [cell + 1): range of parts of a cell
  std::vector<InterfacePiece<dim>> interface;
  std::vector<FacetConnection> connections;
  std::vector<BoundaryPiece> boundary;
  QuadratureSet<dim> volume_quadrature;
  QuadratureSet<dim> interface_quadrature;
  QuadratureSet<dim> boundary_quadrature;
  /// Vertices (cm) of the simplices that fill the cut parts, those of one part in a row; interiors are
  /// disjoint. The volume quadrature holds one rule per simplex, in the same order.
  std::vector<std::array<Point<dim>, dim + 1>> simplices;
  int exact_cells = 0;    ///< cells near solids that were cut in exact arithmetic
  int filtered_cells = 0; ///< cells that were cut in floating point, every sign certain
};

/// Scalar nodal unknowns of the P1 space on the fluid parts. Around a background point the parts that are
/// connected across facets containing the point share one unknown; parts that are not get their own, so that
/// a solid thinner than an element separates the fluid.
template <int dim>
struct DofSets {
  std::vector<std::array<int, dim + 1>> part_dofs; ///< [part][local vertex] -> scalar unknown
  std::vector<int> dof_point;                      ///< [unknown] -> background point
};

/// Scalar unknowns at the mid-points of the background's edges, which the P2 space on the fluid parts has
/// besides those of DofSets. Parts share them by the same rule.
template <int dim>
struct EdgeSets {
  static constexpr int per_part = dim * (dim + 1) / 2;
  /// [part][local edge] -> unknown, counted from 0; edges (0,1), (0,2), .., (1,2), .. of the local vertices.
  std::vector<std::array<int, per_part>> part_edges;
  std::vector<std::array<int, 2>> edge_points; ///< [unknown] -> the background points it is half-way between
};

/// The local vertices that a local edge of a simplex joins, in the order of EdgeSets.
template <int dim>
constexpr std::array<std::array<int, 2>, EdgeSets<dim>::per_part> local_edges() {
  std::array<std::array<int, 2>, EdgeSets<dim>::per_part> edges{};
  int count = 0;
  for (int a = 0; a <= dim; ++a)
    for (int b = a + 1; b <= dim; ++b) edges[count++] = {a, b};
  return edges;
}

} // namespace undula::geometry
