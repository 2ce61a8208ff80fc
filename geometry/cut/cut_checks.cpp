#include "geometry/cut/cut_checks.hpp"

#include <cmath>
#include <numeric>

#include "geometry/mesh/overlap_volume.hpp"
#include "geometry/mesh/polygons.hpp"

namespace undula::geometry {
namespace {

template <int dim>
double measure_of(const Polytope<dim>& shape, const ReferenceRule<dim>& rule) {
  QuadratureSet<dim> set;
  for (const auto& simplex : triangulate<dim, dim>(shape))
    append_simplex_quadrature<dim, dim>(rule, simplex, set);
  return std::accumulate(set.weights.begin(), set.weights.end(), 0.0);
}

template <int dim>
std::array<Point<dim>, dim + 1> corners(const SimplexMesh<dim>& mesh, int cell) {
  std::array<Point<dim>, dim + 1> points;
  for (int v = 0; v <= dim; ++v) points[v] = mesh.points[mesh.cells[cell][v]];
  return points;
}

} // namespace

template <int dim>
std::string error_of_sum(const ExactCell<dim>& near, double sum,
                         const typename BackgroundCutter<dim>::Setup& setup,
                         std::span<const SimplexMesh<dim>> solids) {
  const double element = std::abs(cell_measure(setup.mesh, near.cell));
  double solid = 0, solid_cells = 0;
  for (const auto& removed : near.shape.removed) solid += measure_of<dim>(removed, setup.volume_rule);
  if (!(std::abs(sum + solid - element) <= closure_tolerance * element))
    return "the parts of an element and its solid part do not add up to the element";
  if (near.shape.removed.empty()) return {};
  for (const auto& cell : near.solid_cells) {
    const auto element_corners = corners(setup.mesh, near.cell),
               of_cell = corners(solids[cell.solid], cell.cell);
    if constexpr (dim == 2)
      solid_cells += overlap_area(element_corners, of_cell);
    else
      solid_cells += overlap_volume(element_corners, of_cell);
  }
  if (!(std::abs(solid_cells - solid) <= closure_tolerance * element)) return "solids overlap";
  return {};
}

template <int dim>
std::optional<int> first_open_cell(const CutMesh<dim>& cut,
                                   const typename BackgroundCutter<dim>::Setup& setup,
                                   std::span<const int> cells) {
  std::vector<Point<dim>> sum(cut.parts.size(), Point<dim>::Zero());
  const auto total = [](const QuadratureSet<dim>& set, const auto& piece) {
    return std::accumulate(set.weights.begin() + piece.quadrature_begin,
                           set.weights.begin() + piece.quadrature_end, 0.0);
  };
  for (const auto& piece : cut.interface)
    sum[piece.part] += total(cut.interface_quadrature, piece) * piece.normal;
  for (const auto& piece : cut.boundary)
    sum[piece.part] += total(cut.boundary_quadrature, piece) * setup.shapes[piece.facet].outward;
  for (const auto& connection : cut.connections) {
    const Point<dim> flux = connection.measure * setup.shapes[connection.facet].outward;
    sum[connection.part[0]] += flux;
    sum[connection.part[1]] -= flux;
  }
  for (const int cell : cells) {
    const double scale = std::pow(cell_diameter(cut.mesh, cell), dim - 1);
    for (int part = cut.cell_parts[cell]; part < cut.cell_parts[cell + 1]; ++part)
      if (!(sum[part].norm() <= closure_tolerance * scale)) return cell;
  }
  return std::nullopt;
}

template std::string error_of_sum<2>(const ExactCell<2>&, double, const BackgroundCutter<2>::Setup&,
                                     std::span<const SimplexMesh<2>>);
template std::optional<int> first_open_cell<2>(const CutMesh<2>&, const BackgroundCutter<2>::Setup&,
                                               std::span<const int>);
template std::string error_of_sum<3>(const ExactCell<3>&, double, const BackgroundCutter<3>::Setup&,
                                     std::span<const SimplexMesh<3>>);
template std::optional<int> first_open_cell<3>(const CutMesh<3>&, const BackgroundCutter<3>::Setup&,
                                               std::span<const int>);

} // namespace undula::geometry
