// Scalar diffusion on the fluid's nodes of a cut, with the value 1 on the skin of the solids.
#pragma once

#include <span>

#include "fom/assembly/part_geometry.hpp"
#include "fom/assembly/sparse.hpp"

namespace undula::fom {

/// -div(K grad y) = 0 in the fluid at rest, K = weight * diag(axes) with one weight per part, y = 1 on the
/// skin by Nitsche's method with ghost penalty, free on the boundary. Plain integrals: no factor r in
/// axisymmetric space.
template <int dim>
struct WeightedLaplace {
  SparseMatrix matrix; ///< fluid nodes x fluid nodes, symmetric, positive where a skin is in reach
  Eigen::VectorXd rhs;
};

/// `weights` by part, positive.
template <int dim>
WeightedLaplace<dim> weighted_laplace(const Discretisation<dim>& disc,
                                      std::span<const PartGeometry<dim>> geometries,
                                      std::span<const double> weights, const Point<dim>& axes);

} // namespace undula::fom
