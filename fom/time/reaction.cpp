#include "fom/time/reaction.hpp"

#include <algorithm>
#include <set>

namespace undula::fom {

template <int dim>
Point<dim> force_on_boundary(const Discretisation<dim>& disc, const Eigen::VectorXd& residual,
                             const std::string& name) {
  std::set<int> nodes;
  for (const auto& piece : disc.cut.boundary) {
    if (disc.problem.background.boundary_names[piece.tag] != name) continue;
    const auto& facet = disc.cut.facets.facets[piece.facet];
    const auto& cell = disc.cut.mesh.cells[disc.cut.parts[piece.part].cell];
    for (int local = 0; local <= dim; ++local)
      if (std::find(facet.points.begin(), facet.points.end(), cell[local]) != facet.points.end())
        nodes.insert(disc.fluid_nodes.part_dofs[piece.part][local]);
  }
  Point<dim> force = Point<dim>::Zero();
  for (const int node : nodes) force -= residual.template segment<dim>(disc.velocity_unknown(node, 0));
  return force;
}

template <int dim>
Point<dim> force_on_solid(const Discretisation<dim>& disc, const Operators<dim>& operators,
                          const Eigen::VectorXd& velocities, int solid) {
  // In the rows of a solid these two operators hold the interface and nothing else.
  Eigen::VectorXd traction = operators.physical * velocities + operators.stabilisation * velocities;
  sum_over_ranks(operators.comm, traction);
  Point<dim> force = Point<dim>::Zero();
  for (int u = disc.solid_offset[solid]; u < disc.solid_offset[solid + 1]; u += dim)
    force -= traction.template segment<dim>(u);
  return force;
}

template Point<2> force_on_boundary(const Discretisation<2>&, const Eigen::VectorXd&, const std::string&);
template Point<2> force_on_solid(const Discretisation<2>&, const Operators<2>&, const Eigen::VectorXd&, int);

} // namespace undula::fom
