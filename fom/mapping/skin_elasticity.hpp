// An elastic medium on the fluid's nodes of a cut that takes the displacement of the solids on their skin.
#pragma once

#include <span>

#include "fom/assembly/part_geometry.hpp"
#include "fom/assembly/sparse.hpp"

namespace undula::fom {

/// -div eps(y) = 0 in the fluid at rest, y = g on the skin by Nitsche's method with ghost penalty, free on
/// the boundary: rigid motions of all solids together are met exactly. Plain integrals: no factor r in
/// axisymmetric space. Unknown of component c at fluid node i: i * dim + c.
template <int dim>
struct SkinElasticity {
  SparseMatrix matrix; ///< symmetric; singular for nodes that no skin is connected with
  SparseMatrix data; ///< fluid unknowns x solid unknowns (of all solids in a row): right-hand side = data * g
};

/// `skin_penalty`: Nitsche's, without unit.
template <int dim>
SkinElasticity<dim> skin_elasticity(const Discretisation<dim>& disc,
                                    std::span<const PartGeometry<dim>> geometries, double smoothing_length,
                                    double skin_penalty);

} // namespace undula::fom
