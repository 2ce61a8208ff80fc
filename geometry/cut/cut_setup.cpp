#include "geometry/cut/cut_setup.hpp"

#include <utility>

namespace undula::geometry {
namespace {

template <int dim>
std::vector<FacetShape<dim>> facet_shapes(const SimplexMesh<dim>& mesh, const FacetTable<dim>& table) {
  std::vector<FacetShape<dim>> shapes;
  for (const auto& facet : table.facets) {
    const Point<dim> gradient = barycentric_gradients(mesh, facet.cells[0]).col(facet.local[0]);
    shapes.push_back({-gradient.normalized(), facet_measure(mesh, facet)});
  }
  return shapes;
}

template <int dim>
std::vector<FacetTable<dim>> facet_tables(std::span<const SimplexMesh<dim>> meshes) {
  std::vector<FacetTable<dim>> tables;
  for (const auto& mesh : meshes) tables.push_back(build_facet_table(mesh));
  return tables;
}

} // namespace

template <int dim>
BackgroundCutter<dim>::Setup::Setup(SimplexMesh<dim> background, std::span<const SimplexMesh<dim>> solids,
                                    const CutOptions& cut_options)
    : mesh(std::move(background)),
      facets(build_facet_table(mesh)),
      options(cut_options),
      shapes(facet_shapes(mesh, facets)),
      volume_rule(reference_rule<dim>(options.volume_degree)),
      interface_rule(reference_rule<dim - 1>(options.interface_degree)),
      boundary_rule(reference_rule<dim - 1>(options.boundary_degree)),
      solid_facets(facet_tables(solids)) {
  for (const auto& solid : solids) {
    solid_points.push_back(solid.points.size());
    solid_cells.push_back(solid.cells);
  }
  if constexpr (dim == 2) {
    index.emplace(mesh, facets);
    skin = build_solid_skin(solids, solid_facets);
  } else if (!options.exact) {
    space.emplace(mesh, facets);
    surface = build_skin_surface(solids, solid_facets);
  }
}

template struct BackgroundCutter<2>::Setup;
template struct BackgroundCutter<3>::Setup;

} // namespace undula::geometry
