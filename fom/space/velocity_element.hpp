// Shape functions of the fluid's velocity on one part: linear or quadratic, on the part's element.
#pragma once

#include <algorithm>
#include <array>
#include <type_traits>
#include <vector>

#include "fom/space/discretisation.hpp"

namespace undula::fom {

/// Nodes of one part: its vertices, then with order 2 the mid-points of its edges (see EdgeSets).
template <int dim, int order>
struct VelocityElement {
  static constexpr int nodes = order == 1 ? dim + 1 : QuadraticSpace<dim>::nodes_per_cell;
  using Barycentric = Eigen::Matrix<double, dim + 1, 1>;
  using Values = Eigen::Matrix<double, nodes, 1>;
  using Gradients = Eigen::Matrix<double, dim, nodes>;
  using Coefficients = Eigen::Matrix<double, dim, nodes>; ///< a velocity, column per node

  static Values values(const Barycentric& lambda) {
    if constexpr (order == 1)
      return lambda;
    else
      return quadratic_values<dim>(lambda);
  }

  /// 1/cm, from the gradients of the barycentric coordinates; column per node.
  static Gradients gradients(const Barycentric& lambda, const Eigen::Matrix<double, dim, dim + 1>& g) {
    if constexpr (order == 1)
      return g;
    else
      return quadratic_gradients<dim>(lambda, g);
  }

  static std::array<int, nodes> nodes_of(const Discretisation<dim>& disc, int part) {
    std::array<int, nodes> result{};
    std::copy(disc.fluid_nodes.part_dofs[part].begin(), disc.fluid_nodes.part_dofs[part].end(),
              result.begin());
    if constexpr (order == 2)
      for (int edge = 0; edge < EdgeSets<dim>::per_part; ++edge)
        result[dim + 1 + edge] = disc.vertex_nodes() + disc.fluid_edges.part_edges[part][edge];
    return result;
  }

  static Coefficients coefficients(const Discretisation<dim>& disc, int part, const Eigen::VectorXd& x) {
    const auto at = nodes_of(disc, part);
    Coefficients velocity;
    for (int i = 0; i < nodes; ++i)
      velocity.col(i) = x.template segment<dim>(disc.velocity_unknown(at[i], 0));
    return velocity;
  }
};

/// Calls f with the order of the problem's velocity as a compile-time constant.
template <int dim, class F>
decltype(auto) with_order(const Discretisation<dim>& disc, F&& f) {
  return disc.problem.velocity_order == 2 ? f(std::integral_constant<int, 2>{})
                                          : f(std::integral_constant<int, 1>{});
}

/// Velocity and its gradient, (c, j) = d u_c / d x_j, at a point of a part.
template <int dim>
struct VelocitySample {
  Point<dim> value;
  Eigen::Matrix<double, dim, dim> gradient;
};

/// `gradients`: of the part's barycentric coordinates, where the map puts it, 1/cm. `x`: all unknowns.
template <int dim>
VelocitySample<dim> sample_velocity(const Discretisation<dim>& disc, int part,
                                    const Eigen::Matrix<double, dim, dim + 1>& gradients,
                                    const Eigen::Matrix<double, dim + 1, 1>& lambda,
                                    const Eigen::VectorXd& x) {
  return with_order(disc, [&](auto order) -> VelocitySample<dim> {
    using Element = VelocityElement<dim, order>;
    const auto velocity = Element::coefficients(disc, part, x);
    return {velocity * Element::values(lambda), velocity * Element::gradients(lambda, gradients).transpose()};
  });
}

/// Pressure at a point of a part, dyn/cm^2.
template <int dim>
double sample_pressure(const Discretisation<dim>& disc, int part,
                       const Eigen::Matrix<double, dim + 1, 1>& lambda, const Eigen::VectorXd& x) {
  double pressure = 0;
  for (int a = 0; a <= dim; ++a)
    pressure += lambda[a] * x[disc.pressure_unknown(disc.fluid_nodes.part_dofs[part][a])];
  return pressure;
}

/// The velocity nodes of a part on a facet of its element.
template <int dim>
std::vector<int> facet_velocity_nodes(const Discretisation<dim>& disc, int part, int facet) {
  const auto& on_facet = disc.cut.facets.facets[facet].points;
  const auto& cell = disc.cut.mesh.cells[disc.cut.parts[part].cell];
  const auto touches = [&](int local) {
    return std::find(on_facet.begin(), on_facet.end(), cell[local]) != on_facet.end();
  };
  std::vector<int> nodes;
  for (int local = 0; local <= dim; ++local)
    if (touches(local)) nodes.push_back(disc.fluid_nodes.part_dofs[part][local]);
  if (disc.problem.velocity_order == 1) return nodes;
  constexpr auto edges = local_edges<dim>();
  for (std::size_t edge = 0; edge < edges.size(); ++edge)
    if (touches(edges[edge][0]) && touches(edges[edge][1]))
      nodes.push_back(disc.vertex_nodes() + disc.fluid_edges.part_edges[part][edge]);
  return nodes;
}

} // namespace undula::fom
