// The two fluid parts that meet at a facet, and the jump of gradients between them.
#pragma once

#include <algorithm>
#include <array>

#include "fom/assembly/part_geometry.hpp"

namespace undula::fom {

/// Linear forms on the nodes of both parts: those of the first part in its order, then the one of the second
/// part off the facet. Connected parts share the nodes of their facet.
template <int dim>
struct FacetPatch {
  std::array<int, dim + 2> nodes;                    ///< fluid nodes
  Eigen::Matrix<double, dim, dim + 2> gradient_jump; ///< by node: first part minus second
  Eigen::Matrix<double, dim + 2, 1> normal_jump;     ///< of the derivative along the normal
  Point<dim> normal;                                 ///< unit
  Point<dim> centre = Point<dim>::Zero();            ///< of the facet, cm
  int opposite = 0;                                  ///< vertex of the first part off the facet
  /// Of the whole facet, also where a solid covers a piece of it, times the weight of the first part,
  /// cm^(dim-1).
  double area = 0;
  double size = 0;  ///< diameter of the larger element at rest, thinned as its height above the facet, cm
  bool cut = false; ///< whether one of the parts is
};

/// `geometry`: of the connection's two parts.
template <int dim>
FacetPatch<dim> facet_patch(const Discretisation<dim>& disc, const FacetConnection& connection,
                            const PartGeometry<dim>& first, const PartGeometry<dim>& second) {
  const auto& facet = disc.cut.facets.facets[connection.facet];
  FacetPatch<dim> patch;
  patch.gradient_jump.setZero();
  int count = 0;
  double thinning = 0;
  for (int side = 0; side < 2; ++side) {
    const int part = connection.part[side], cell = disc.cut.parts[part].cell;
    const auto& geometry = side == 0 ? first : second;
    const int local = facet.local[facet.cells[0] == cell ? 0 : 1];
    for (int a = 0; a <= dim; ++a) {
      const int node = disc.fluid_nodes.part_dofs[part][a];
      const auto end = patch.nodes.begin() + count;
      const auto at = std::find(patch.nodes.begin(), end, node) - patch.nodes.begin();
      if (at == count) patch.nodes[count++] = node;
      patch.gradient_jump.col(at) += (side == 0 ? 1.0 : -1.0) * geometry.gradients.col(a);
      if (side == 0 && a != local) patch.centre += geometry.corners.col(a) / dim;
    }
    const double height_ratio =
        geometry.reference_gradients.col(local).norm() / geometry.gradients.col(local).norm();
    thinning = std::max(thinning, height_ratio);
    patch.size = std::max(patch.size, cell_diameter(disc.cut.mesh, cell));
    patch.cut = patch.cut || disc.cut.parts[part].cut;
    if (side > 0) continue;
    patch.opposite = local;
    const double steepness = geometry.gradients.col(local).norm();
    patch.normal = geometry.gradients.col(local) / steepness;
    patch.area =
        geometry.weight * dim * cell_measure(disc.cut.mesh, cell) * geometry.volume_ratio * steepness;
  }
  // The size that counts is the one across the facet: it changes as the heights of the two elements above it
  // do.
  patch.size *= thinning;
  patch.normal_jump = patch.gradient_jump.transpose() * patch.normal;
  return patch;
}

} // namespace undula::fom
