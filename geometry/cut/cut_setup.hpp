// What a background and the topology of its solids prepare for all cuts.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/cut/cut.hpp"
#include "geometry/cut/plane/skin_walk.hpp"
#include "geometry/cut/space/skin_surface.hpp"
#include "geometry/cut/space/space_index.hpp"
#include "geometry/mesh/quadrature.hpp"

namespace undula::geometry {

/// Of a facet.
template <int dim>
struct FacetShape {
  Point<dim> outward; ///< unit normal, outward from the first cell
  double measure;     ///< cm^(dim - 1)
};

template <int dim>
struct BackgroundCutter<dim>::Setup {
  Setup(SimplexMesh<dim> background, std::span<const SimplexMesh<dim>> solids, const CutOptions& cut_options);
  Setup(const Setup&) = delete; // the index looks into the mesh

  SimplexMesh<dim> mesh;
  FacetTable<dim> facets;
  CutOptions options;
  std::vector<FacetShape<dim>> shapes; // by facet
  ReferenceRule<dim> volume_rule;
  ReferenceRule<dim - 1> interface_rule;
  ReferenceRule<dim - 1> boundary_rule;
  std::vector<FacetTable<dim>> solid_facets;
  std::vector<std::size_t> solid_points;
  std::vector<std::vector<std::array<int, dim + 1>>> solid_cells;
  std::optional<BackgroundIndex> index; // 2D
  SolidSkin skin;                       // 2D
  std::optional<SpaceIndex> space;      // 3D
  SkinSurface surface;                  // 3D
};

} // namespace undula::geometry
