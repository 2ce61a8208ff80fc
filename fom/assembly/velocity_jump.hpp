// Interior penalty on jumps of the velocity gradient, scaled by the flow across each facet.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "fom/assembly/forms.hpp"

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

/// Of all facets of the share.
template <int dim>
std::vector<VelocityJump<dim>> velocity_jumps(const Discretisation<dim>& disc, const Share& share,
                                              std::span<const PartGeometry<dim>> geometries);

/// Visits every entry (row, column, value) for the convecting field `b`; on a domain that moves by a map b -
/// w crosses the facets. The speed of a facet is the mean of |b.n| at its vertices. The sequence of (row,
/// column) does not depend on `b`.
template <int dim, class F>
void visit_velocity_jumps(const Discretisation<dim>& disc, std::span<const VelocityJump<dim>> jumps,
                          const Eigen::VectorXd& b, F&& f) {
  const bool moved = !disc.map.is_identity();
  for (const auto& jump : jumps) {
    Eigen::Matrix<double, dim, dim + 1> domain;
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
}

} // namespace undula::fom
