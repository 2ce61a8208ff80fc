// Interior penalty on jumps of the velocity gradient, scaled by the flow across each facet.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "fom/assembly/forms.hpp"
#include "fom/assembly/quadratic_patch.hpp"

namespace undula::fom {

/// weight * |b.n| ([d u/dn], [d v/dn]) of one facet, but for the speed |b.n| (Burman, Fernandez & Hansbo,
/// SIAM J. Numer. Anal. 44, 2006).
template <int dim>
struct VelocityJump {
  std::array<int, dim + 2> nodes;                ///< as in FacetPatch
  Eigen::Matrix<double, dim + 2, 1> normal_jump; ///< 1/cm
  Point<dim> normal;
  int opposite = 0;  ///< vertex of the first part off the facet
  int part = 0;      ///< the first
  double weight = 0; ///< velocity_jump * density * h^2 * area
};

/// The same of a quadratic velocity, whose jump varies along the facet.
template <int dim>
struct QuadraticVelocityJump {
  using Patch = QuadraticPatch<dim>;
  std::array<int, Patch::nodes_of_both> nodes; ///< as in QuadraticPatch, as what follows
  std::array<typename Patch::Form, Patch::points> normal_jump;
  std::array<typename Patch::Element::Barycentric, Patch::points> lambda;
  Point<dim> normal;
  int part = 0; ///< the first
  std::array<double, Patch::points> weight{};
};

/// Of the velocities' degree; the other list is empty.
template <int dim>
struct VelocityJumps {
  std::vector<VelocityJump<dim>> linear;
  std::vector<QuadraticVelocityJump<dim>> quadratic;
  bool empty() const { return linear.empty() && quadratic.empty(); }
};

/// Of all facets of the share; none where no local velocity scales them, or nothing convects.
template <int dim>
VelocityJumps<dim> velocity_jumps(const Discretisation<dim>& disc, const Share& share,
                                  std::span<const PartGeometry<dim>> geometries);

/// Visits every entry (row, column, value) for the convecting field `b`; on a domain that moves by a map b -
/// w crosses the facets. The speed at a facet of linear velocities is the mean of |b.n| at its vertices. The
/// sequence of (row, column) does not depend on `b`.
template <int dim, class F>
void visit_velocity_jumps(const Discretisation<dim>& disc, const VelocityJumps<dim>& jumps,
                          const Eigen::VectorXd& b, F&& f) {
  const bool moved = !disc.map.is_identity();
  for (const auto& jump : jumps.linear) {
    Eigen::Matrix<double, dim, dim + 1> domain = Eigen::Matrix<double, dim, dim + 1>::Zero();
    if (moved) domain = domain_velocity(disc, jump.part);
    double speed = 0;
    for (int a = 0; a <= dim; ++a) {
      if (a == jump.opposite) continue;
      Point<dim> relative = b.template segment<dim>(disc.velocity_unknown(jump.nodes[a], 0));
      if (moved) relative -= domain.col(a);
      speed += std::abs(relative.dot(jump.normal)) / dim;
    }
    for (int i = 0; i < dim + 2; ++i)
      for (int j = 0; j < dim + 2; ++j) {
        const double value = jump.weight * speed * jump.normal_jump[i] * jump.normal_jump[j];
        for (int c = 0; c < dim; ++c)
          f(disc.velocity_unknown(jump.nodes[i], c), disc.velocity_unknown(jump.nodes[j], c), value);
      }
  }
  using Element = VelocityElement<dim, 2>;
  constexpr int nodes = QuadraticPatch<dim>::nodes_of_both;
  for (const auto& jump : jumps.quadratic) {
    Eigen::Matrix<double, dim, dim + 1> domain = Eigen::Matrix<double, dim, dim + 1>::Zero();
    if (moved) domain = domain_velocity(disc, jump.part);
    const auto velocity = Element::coefficients(disc, jump.part, b);
    Eigen::Matrix<double, nodes, nodes> local = Eigen::Matrix<double, nodes, nodes>::Zero();
    for (int q = 0; q < QuadraticPatch<dim>::points; ++q) {
      Point<dim> relative = velocity * Element::values(jump.lambda[q]);
      if (moved) relative -= domain * jump.lambda[q];
      const auto& form = jump.normal_jump[q];
      local.noalias() += (jump.weight[q] * std::abs(relative.dot(jump.normal)) * form) * form.transpose();
    }
    for (int i = 0; i < nodes; ++i)
      for (int j = 0; j < nodes; ++j)
        for (int c = 0; c < dim; ++c)
          f(disc.velocity_unknown(jump.nodes[i], c), disc.velocity_unknown(jump.nodes[j], c), local(i, j));
  }
}

} // namespace undula::fom
