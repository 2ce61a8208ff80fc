// The walls of a problem: facets of its background with an imposed velocity.
#pragma once

#include "fom/problem/problem.hpp"

namespace undula::fom {

template <int dim>
struct BoundaryWall {
  std::array<Point<dim>, dim> points; ///< cm
  Point<dim> normal;                  ///< into the fluid, unit
  double height = 0;                  ///< of the element on it, cm
  int facet = -1;                     ///< in the facet table of the background
};

/// In the order of the facet table.
template <int dim>
std::vector<BoundaryWall<dim>> boundary_walls(const FsiProblem<dim>& problem) {
  std::vector<BoundaryWall<dim>> walls;
  const auto& background = problem.background;
  const auto table = build_facet_table(background);
  for (std::size_t f = 0; f < table.facets.size(); ++f) {
    const auto& facet = table.facets[f];
    if (facet.cells[1] >= 0) continue;
    const auto& condition = problem.boundary.at(background.boundary_names[facet.boundary_tag]);
    if (condition.kind != BoundaryCondition<dim>::Kind::velocity) continue;
    auto& wall = walls.emplace_back();
    for (int i = 0; i < dim; ++i) wall.points[i] = background.points[facet.points[i]];
    const Point<dim> inward = barycentric_gradients(background, facet.cells[0]).col(facet.local[0]);
    wall.normal = inward.normalized();
    wall.height = 1 / inward.norm();
    wall.facet = static_cast<int>(f);
  }
  return walls;
}

} // namespace undula::fom
