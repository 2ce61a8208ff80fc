// Where the boundary holds the map of the domain.
#pragma once

#include <vector>

#include "fom/assembly/sparse.hpp"
#include "fom/space/discretisation.hpp"
#include "fom/space/facet_axis.hpp"

namespace undula::fom {

/// Fluid nodes where that component of the map's displacement vanishes: walls and openings; of symmetric
/// boundaries the normal component alone.
template <int dim>
std::vector<char> nodes_at_rest(const Discretisation<dim>& disc, int component) {
  using Kind = typename BoundaryCondition<dim>::Kind;
  std::vector<char> at_rest(disc.fluid_nodes.dof_point.size(), 0);
  for (const auto& piece : disc.cut.boundary) {
    const auto& condition = disc.problem.boundary.at(disc.problem.background.boundary_names[piece.tag]);
    if (condition.kind == Kind::symmetry && component != normal_axis(disc.cut, piece.facet)) continue;
    const int opposite = disc.cut.facets.facets[piece.facet].local[0];
    for (int a = 0; a <= dim; ++a)
      if (a != opposite) at_rest[disc.fluid_nodes.part_dofs[piece.part][a]] = 1;
  }
  return at_rest;
}

/// Rows and columns of unknowns at rest replaced by the identity.
inline void hold(const std::vector<char>& at_rest, SparseMatrix& matrix) {
  for (int row = 0; row < matrix.outerSize(); ++row)
    for (SparseMatrix::InnerIterator entry(matrix, row); entry; ++entry)
      if (at_rest[row] || at_rest[entry.col()]) entry.valueRef() = entry.col() == row ? 1.0 : 0.0;
}

/// A trace of a zeroth-order term, for nodes that no skin is connected with.
inline void keep_regular(SparseMatrix& matrix) {
  for (int row = 0; row < matrix.outerSize(); ++row) matrix.coeffRef(row, row) *= 1 + 1e-13;
}

} // namespace undula::fom
