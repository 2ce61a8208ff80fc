// Jumps of the normal derivative over facets, for the ghost penalty and the smoothness of the map's fields.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "fom/assembly/part_geometry.hpp"

namespace undula {

/// The two parts at a facet, at rest. jump . values = jump of the normal derivative of the linear field with
/// these nodal values.
template <int dim>
struct FacetJump {
  std::array<int, 2> part;
  std::array<int, 2 * (dim + 1)> nodes;   ///< fluid nodes of both parts
  std::array<double, 2 * (dim + 1)> jump; ///< 1/cm
  Point<dim> normal;                      ///< unit
  double size = 0;                        ///< diameter of the larger cell, cm
  double area = 0;                        ///< of the whole facet, cm^(dim - 1)
  bool cut = false;                       ///< one of the parts, or both
};

/// Calls f(FacetJump<dim>) for every facet between fluid parts.
template <int dim, class F>
void for_each_facet_jump(const Discretisation<dim>& disc, std::span<const PartGeometry<dim>> geometries,
                         F&& f) {
  const auto& mesh = disc.cut.mesh;
  for (const auto& connection : disc.cut.connections) {
    const int first = connection.part[0], second = connection.part[1];
    const auto& facet = disc.cut.facets.facets[connection.facet];
    const int cell = disc.cut.parts[first].cell;
    const auto opposite =
        geometries[first].reference_gradients.col(facet.local[facet.cells[0] == cell ? 0 : 1]);
    FacetJump<dim> jump;
    jump.part = {first, second};
    jump.cut = disc.cut.parts[first].cut || disc.cut.parts[second].cut;
    jump.normal = opposite.normalized();
    jump.size = std::max(cell_diameter(mesh, cell), cell_diameter(mesh, disc.cut.parts[second].cell));
    jump.area = dim * cell_measure(mesh, cell) * opposite.norm();
    for (int a = 0; a <= dim; ++a) {
      jump.nodes[a] = disc.fluid_nodes.part_dofs[first][a];
      jump.nodes[dim + 1 + a] = disc.fluid_nodes.part_dofs[second][a];
      jump.jump[a] = geometries[first].reference_gradients.col(a).dot(jump.normal);
      jump.jump[dim + 1 + a] = -geometries[second].reference_gradients.col(a).dot(jump.normal);
    }
    f(jump);
  }
}

} // namespace undula
