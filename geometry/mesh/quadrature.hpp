// Quadrature on simplices of any dimension: conical products of Gauss-Jacobi rules.
#pragma once

#include <array>
#include <vector>

#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::geometry {

/// Points and weights in physical space; weights are plain (no factor r): the measure is applied by the
/// forms.
template <int dim>
struct QuadratureSet {
  std::vector<Point<dim>> points; ///< cm
  std::vector<double> weights;    ///< cm^k, k the dimension of what is integrated over
};

/// Rule on the reference simplex of dimension `dim` in barycentric coordinates, weights summing to 1.
/// Exact for polynomials of degree <= `degree` (>= 0). Positive weights, points inside.
template <int dim>
struct ReferenceRule {
  std::vector<Eigen::Matrix<double, dim + 1, 1>> barycentric;
  std::vector<double> weights;
};
template <int dim>
ReferenceRule<dim> reference_rule(int degree);

/// Appends the rule for the k-simplex with the given k+1 vertices in R^dim to `set`.
template <int dim, int k>
void append_simplex_quadrature(const ReferenceRule<k>& rule, const std::array<Point<dim>, k + 1>& vertices,
                               QuadratureSet<dim>& set);

} // namespace undula::geometry
