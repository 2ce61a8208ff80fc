#include "geometry/mesh/simplex_mesh.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "rom/base/error.hpp"

namespace undula::geometry {
namespace {

template <int dim>
Eigen::Matrix<double, dim, dim> edge_matrix(const SimplexMesh<dim>& mesh, int cell) {
  const auto& points = mesh.cells[cell];
  Eigen::Matrix<double, dim, dim> edges;
  for (int i = 0; i < dim; ++i) edges.col(i) = mesh.points[points[i + 1]] - mesh.points[points[0]];
  return edges;
}

template <int dim>
std::string point_list(const std::array<int, dim>& points) {
  std::string text = "points";
  for (const int p : points) text += " " + std::to_string(p);
  return text;
}

} // namespace

template <int dim>
FacetTable<dim> build_facet_table(const SimplexMesh<dim>& mesh) {
  struct Side {
    std::array<int, dim> points;
    int cell, local;
    bool operator<(const Side& other) const {
      return std::tie(points, cell, local) < std::tie(other.points, other.cell, other.local);
    }
  };
  std::vector<Side> sides;
  sides.reserve(mesh.cells.size() * (dim + 1));
  for (int cell = 0; cell < static_cast<int>(mesh.cells.size()); ++cell) {
    for (int local = 0; local <= dim; ++local) {
      Side side{{}, cell, local};
      for (int i = 0, k = 0; i <= dim; ++i)
        if (i != local) side.points[k++] = mesh.cells[cell][i];
      std::sort(side.points.begin(), side.points.end());
      sides.push_back(side);
    }
  }
  std::sort(sides.begin(), sides.end());

  FacetTable<dim> table;
  table.cell_facets.resize(mesh.cells.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const bool second = i > 0 && sides[i].points == sides[i - 1].points;
    if (!second) table.facets.emplace_back().points = sides[i].points;
    auto& facet = table.facets.back();
    if (facet.cells[1] >= 0)
      throw InputError("a facet of the mesh has more than two cells", point_list<dim>(facet.points),
                       "one or two cells per facet", "the mesh");
    facet.cells[second] = sides[i].cell;
    facet.local[second] = sides[i].local;
    table.cell_facets[sides[i].cell][sides[i].local] = static_cast<int>(table.facets.size()) - 1;
  }

  for (const auto& boundary : mesh.boundary) {
    auto points = boundary.points;
    std::sort(points.begin(), points.end());
    const auto found =
        std::lower_bound(table.facets.begin(), table.facets.end(), points,
                         [](const auto& facet, const auto& key) { return facet.points < key; });
    if (found == table.facets.end() || found->points != points || found->cells[1] >= 0)
      throw InputError("a boundary facet is not on the boundary of the mesh", point_list<dim>(points),
                       "facets with exactly one cell", "the boundary of the mesh");
    found->boundary_tag = boundary.tag;
  }
  return table;
}

template <int dim>
double cell_measure(const SimplexMesh<dim>& mesh, int cell) {
  constexpr double factorial = dim == 3 ? 6 : dim;
  return edge_matrix<dim>(mesh, cell).determinant() / factorial;
}

template <int dim>
double facet_measure(const SimplexMesh<dim>& mesh, const Facet<dim>& facet) {
  // |grad lambda| is one over the height, and the cell is facet times height / dim.
  const double slope = barycentric_gradients(mesh, facet.cells[0]).col(facet.local[0]).norm();
  return std::abs(cell_measure(mesh, facet.cells[0])) * dim * slope;
}

template <int dim>
double cell_diameter(const SimplexMesh<dim>& mesh, int cell) {
  double longest = 0;
  for (const int a : mesh.cells[cell])
    for (const int b : mesh.cells[cell])
      longest = std::max(longest, (mesh.points[a] - mesh.points[b]).norm());
  return longest;
}

template <int dim>
Eigen::Matrix<double, dim, dim + 1> barycentric_gradients(const SimplexMesh<dim>& mesh, int cell) {
  Eigen::Matrix<double, dim, dim + 1> gradients;
  gradients.template rightCols<dim>() = edge_matrix<dim>(mesh, cell).inverse().transpose();
  gradients.col(0) = -gradients.template rightCols<dim>().rowwise().sum();
  return gradients;
}

template <int dim>
Eigen::Matrix<double, dim + 1, 1> barycentric_coordinates(const SimplexMesh<dim>& mesh, int cell,
                                                          const Point<dim>& x) {
  Eigen::Matrix<double, dim + 1, 1> lambda;
  lambda.template tail<dim>() =
      edge_matrix<dim>(mesh, cell).inverse() * (x - mesh.points[mesh.cells[cell][0]]);
  lambda[0] = 1 - lambda.template tail<dim>().sum();
  return lambda;
}

#define UNDULA_INSTANTIATE(dim)                                                                          \
  template FacetTable<dim> build_facet_table<dim>(const SimplexMesh<dim>&);                              \
  template double cell_measure<dim>(const SimplexMesh<dim>&, int);                                       \
  template double facet_measure(const SimplexMesh<dim>&, const Facet<dim>&);                             \
  template double cell_diameter<dim>(const SimplexMesh<dim>&, int);                                      \
  template Eigen::Matrix<double, dim, dim + 1> barycentric_gradients<dim>(const SimplexMesh<dim>&, int); \
  template Eigen::Matrix<double, dim + 1, 1> barycentric_coordinates<dim>(const SimplexMesh<dim>&, int,  \
                                                                          const Point<dim>&);
UNDULA_INSTANTIATE(2)
UNDULA_INSTANTIATE(3)
#undef UNDULA_INSTANTIATE

} // namespace undula::geometry
