#include "geometry/cut/exact/hyperplane_table.hpp"

#include <algorithm>
#include <string>

#include "rom/base/error.hpp"

namespace undula::geometry {
namespace {

// Normal to the facet with the given edges (generalised cross product).
ExactPoint<2> facet_normal(const std::array<ExactPoint<2>, 1>& e) { return {-e[0][1], e[0][0]}; }
ExactPoint<3> facet_normal(const std::array<ExactPoint<3>, 2>& e) {
  return {e[0][1] * e[1][2] - e[0][2] * e[1][1], e[0][2] * e[1][0] - e[0][0] * e[1][2],
          e[0][0] * e[1][1] - e[0][1] * e[1][0]};
}

} // namespace

template <int dim>
HyperplaneTable<dim>::HyperplaneTable(std::vector<const SimplexMesh<dim>*> meshes,
                                      std::vector<const FacetTable<dim>*> facets)
    : meshes_(std::move(meshes)), facets_(std::move(facets)) {
  int count = 0;
  for (const auto* table : facets_) {
    first_.push_back(count);
    count += static_cast<int>(table->facets.size());
  }
  planes_.resize(count);
}

template <int dim>
std::array<HalfSpace, dim + 1> HyperplaneTable<dim>::sides(int mesh, int cell) const {
  std::array<HalfSpace, dim + 1> sides;
  for (int i = 0; i <= dim; ++i) {
    const int facet = facets_[mesh]->cell_facets[cell][i];
    sides[i] = {plane(mesh, facet), facets_[mesh]->facets[facet].cells[0] == cell};
  }
  return sides;
}

template <int dim>
auto HyperplaneTable<dim>::origin(int plane) const -> Origin {
  const auto above = std::upper_bound(first_.begin(), first_.end(), plane);
  const int mesh = static_cast<int>(above - first_.begin()) - 1;
  return {mesh, plane - first_[mesh]};
}

template <int dim>
const Hyperplane<dim>& HyperplaneTable<dim>::operator[](int plane) const {
  auto& entry = planes_[plane];
  if (!entry) {
    const auto [mesh, facet] = origin(plane);
    entry = make(mesh, facets_[mesh]->facets[facet]);
  }
  return *entry;
}

template <int dim>
Hyperplane<dim> HyperplaneTable<dim>::make(int mesh, const Facet<dim>& facet) const {
  const auto& points = meshes_[mesh]->points;
  const ExactPoint<dim> origin = exact_point<dim>(points[facet.points[0]]);
  std::array<ExactPoint<dim>, dim - 1> edges;
  for (int e = 0; e < dim - 1; ++e) {
    edges[e] = exact_point<dim>(points[facet.points[e + 1]]);
    for (int i = 0; i < dim; ++i) edges[e][i] -= origin[i];
  }
  Hyperplane<dim> plane{facet_normal(edges), Exact(0)};
  plane.offset = plane.excess(origin);

  for (int k = 0; k < 2 && facet.cells[k] >= 0; ++k) {
    const int opposite = meshes_[mesh]->cells[facet.cells[k]][facet.local[k]];
    const auto sign = plane.side(exact_point<dim>(points[opposite]));
    if (k == 0 && sign == CGAL::NEGATIVE) {
      for (auto& component : plane.normal) component = -component;
      plane.offset = -plane.offset;
    } else if (sign != (k == 0 ? CGAL::POSITIVE : CGAL::NEGATIVE)) {
      const std::string name = mesh == 0 ? "background mesh" : "solid mesh " + std::to_string(mesh - 1);
      throw NumericsError(
          sign == CGAL::ZERO ? "a cell of a mesh to be cut is flat" : "a mesh to be cut is folded",
          "cell " + std::to_string(facet.cells[k]) + " of the " + name,
          "a smaller time step or stroke, or a mesh without flat cells");
    }
  }
  return plane;
}

template class HyperplaneTable<2>;
template class HyperplaneTable<3>;

} // namespace undula::geometry
