// Simplicial meshes in two and three dimensions: plain data shared by every room above.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace undula::geometry {

/// Coordinates in cm; in axisymmetric space (x, y) = (r, z).
template <int dim>
using Point = Eigen::Matrix<double, dim, 1>;

/// A simplex of the boundary of a mesh with the tag of the boundary part it lies on.
template <int dim>
struct BoundaryFacet {
  std::array<int, dim> points; ///< indices into SimplexMesh::points
  int tag = 0;                 ///< index into SimplexMesh::boundary_names
};

/// Conforming simplicial mesh. Cells are positively oriented (det of the edge matrix > 0).
template <int dim>
struct SimplexMesh {
  std::vector<Point<dim>> points;              ///< cm
  std::vector<std::array<int, dim + 1>> cells; ///< point indices, positively oriented
  std::vector<BoundaryFacet<dim>> boundary;    ///< every facet with one cell only, once
  std::vector<std::string> boundary_names; ///< name of boundary tag i, e.g. "wall", "axis", "inlet", "outlet"
};

/// A facet of a mesh with its one or two cells. `local[k]` is the vertex of cell `cells[k]` opposite the
/// facet.
template <int dim>
struct Facet {
  std::array<int, dim> points;      ///< ascending
  std::array<int, 2> cells{-1, -1}; ///< cells[1] = -1 on the boundary
  std::array<int, 2> local{-1, -1};
  int boundary_tag = -1; ///< -1 inside
};

/// All facets of a mesh and, per cell, the facet opposite each of its vertices.
template <int dim>
struct FacetTable {
  std::vector<Facet<dim>> facets;
  std::vector<std::array<int, dim + 1>> cell_facets; ///< [cell][opposite vertex] -> index into facets
};

/// Builds the facet table. Boundary tags are taken from mesh.boundary (-1 stays where none is given).
/// Throws InputError when a facet has more than two cells.
template <int dim>
FacetTable<dim> build_facet_table(const SimplexMesh<dim>& mesh);

/// Signed measure of a cell (area or volume, cm^dim).
template <int dim>
double cell_measure(const SimplexMesh<dim>& mesh, int cell);

/// Measure of a facet, cm^(dim - 1).
template <int dim>
double facet_measure(const SimplexMesh<dim>& mesh, const Facet<dim>& facet);

/// Diameter of a cell: its longest edge, cm.
template <int dim>
double cell_diameter(const SimplexMesh<dim>& mesh, int cell);

/// Gradients of the barycentric coordinates of a cell; column i belongs to vertex i. 1/cm.
template <int dim>
Eigen::Matrix<double, dim, dim + 1> barycentric_gradients(const SimplexMesh<dim>& mesh, int cell);

/// Barycentric coordinates of x in a cell (affine, also outside of it).
template <int dim>
Eigen::Matrix<double, dim + 1, 1> barycentric_coordinates(const SimplexMesh<dim>& mesh, int cell,
                                                          const Point<dim>& x);

/// A cell of one of several solids' meshes.
struct SolidCell {
  int solid = -1;
  int cell = -1;
};

} // namespace undula::geometry
