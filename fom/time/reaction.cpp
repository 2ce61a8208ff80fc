#include "fom/time/reaction.hpp"

#include <set>

#include "fom/space/velocity_element.hpp"

namespace undula::fom {

template <int dim>
Point<dim> force_on_boundary(const Discretisation<dim>& disc, const Eigen::VectorXd& residual,
                             const std::string& name) {
  std::set<int> nodes;
  for (const auto& piece : disc.cut.boundary) {
    if (disc.problem.background.boundary_names[piece.tag] != name) continue;
    const auto on_facet = facet_velocity_nodes(disc, piece.part, piece.facet);
    nodes.insert(on_facet.begin(), on_facet.end());
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

template Point<3> force_on_boundary(const Discretisation<3>&, const Eigen::VectorXd&, const std::string&);
template Point<3> force_on_solid(const Discretisation<3>&, const Operators<3>&, const Eigen::VectorXd&, int);

} // namespace undula::fom
