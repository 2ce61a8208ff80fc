// The jumps of a quadratic velocity between the two fluid parts that meet at a facet.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "fom/assembly/facet_patch.hpp"
#include "fom/space/velocity_element.hpp"

namespace undula::fom {

/// Linear forms on the velocity nodes of both parts: those of the first part in its order, then the ones of
/// the second part off the facet. Connected parts share the nodes of their facet.
template <int dim>
struct QuadraticPatch {
  using Element = VelocityElement<dim, 2>;
  static constexpr int nodes_on_facet = dim * (dim + 1) / 2,
                       nodes_of_both = 2 * Element::nodes - nodes_on_facet;
  /// Of equal weight: squared jumps of first derivatives are exact, in axisymmetric space times r.
  static constexpr int points = dim;
  using Form = Eigen::Matrix<double, nodes_of_both, 1>;

  std::array<int, nodes_of_both> nodes; ///< velocity nodes
  /// By point: jump of the gradient (first part minus second) and its part along the normal.
  std::array<Eigen::Matrix<double, dim, nodes_of_both>, points> gradient_jump;
  std::array<Form, points> normal_jump;
  /// Barycentric coordinates of the points in the first part.
  std::array<typename Element::Barycentric, points> lambda;
  Form second_jump = Form::Zero();     ///< of the second derivative along the normal, constant on the facet
  std::array<double, points> radius{}; ///< first coordinate of the points, cm
};

/// Barycentric coordinates of the points on a facet: Gauss's two on an edge; three inside of a triangle
/// (Strang & Fix 1973).
template <int dim>
std::array<std::array<double, dim>, dim> facet_points() {
  if constexpr (dim == 2) {
    const double gauss = 0.5 / std::sqrt(3.0), first = 0.5 - gauss, second = 0.5 + gauss;
    return {{{1 - first, first}, {1 - second, second}}};
  } else {
    constexpr double near = 2.0 / 3, far = 1.0 / 6;
    return {{{near, far, far}, {far, near, far}, {far, far, near}}};
  }
}

/// `linear`: the facet's FacetPatch; `first`, `second`: geometry of the connection's two parts.
template <int dim>
QuadraticPatch<dim> quadratic_patch(const Discretisation<dim>& disc, const FacetConnection& connection,
                                    const FacetPatch<dim>& linear, const PartGeometry<dim>& first,
                                    const PartGeometry<dim>& second) {
  using Patch = QuadraticPatch<dim>;
  using Element = typename Patch::Element;
  const auto rule = facet_points<dim>();
  const auto& on_facet = disc.cut.facets.facets[connection.facet].points;
  Patch patch;
  for (auto& jump : patch.gradient_jump) jump.setZero();
  int count = 0;
  for (int side = 0; side < 2; ++side) {
    const int part = connection.part[side];
    const auto& geometry = side == 0 ? first : second;
    const double sign = side == 0 ? 1.0 : -1.0;
    const auto nodes = Element::nodes_of(disc, part);
    std::array<int, Element::nodes> place;
    for (int i = 0; i < Element::nodes; ++i) {
      const auto end = patch.nodes.begin() + count;
      place[i] = static_cast<int>(std::find(patch.nodes.begin(), end, nodes[i]) - patch.nodes.begin());
      if (place[i] == count) patch.nodes[count++] = nodes[i];
    }
    const auto& cell = disc.cut.mesh.cells[disc.cut.parts[part].cell];
    const auto local = [&](int point) {
      return static_cast<Eigen::Index>(std::find(cell.begin(), cell.end(), point) - cell.begin());
    };
    for (int q = 0; q < Patch::points; ++q) {
      typename Element::Barycentric lambda = Element::Barycentric::Zero();
      for (int k = 0; k < dim; ++k) lambda[local(on_facet[k])] = rule[q][k];
      const auto gradients = Element::gradients(lambda, geometry.gradients);
      for (int i = 0; i < Element::nodes; ++i)
        patch.gradient_jump[q].col(place[i]) += sign * gradients.col(i);
      if (side > 0) continue;
      patch.lambda[q] = lambda;
      patch.radius[q] = geometry.corners.row(0).dot(lambda);
    }
    // lambda_a (2 lambda_a - 1) and 4 lambda_a lambda_b, twice along the normal.
    const Eigen::Matrix<double, dim + 1, 1> slope = geometry.gradients.transpose() * linear.normal;
    for (int a = 0; a <= dim; ++a) patch.second_jump[place[a]] += sign * 4 * slope[a] * slope[a];
    constexpr auto edges = local_edges<dim>();
    for (std::size_t e = 0; e < edges.size(); ++e)
      patch.second_jump[place[dim + 1 + e]] += sign * 8 * slope[edges[e][0]] * slope[edges[e][1]];
  }
  for (int q = 0; q < Patch::points; ++q)
    patch.normal_jump[q] = patch.gradient_jump[q].transpose() * linear.normal;
  return patch;
}

} // namespace undula::fom
