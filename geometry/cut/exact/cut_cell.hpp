// The fluid parts of one background cell, as convex pieces in exact arithmetic.
#pragma once

#include <span>
#include <vector>

#include "geometry/cut/exact/convex_clip.hpp"

namespace undula::geometry {

/// Background is mesh 0 of the hyperplane table, solid s is mesh s + 1.
inline int mesh_of_solid(int solid) { return solid + 1; }

template <int dim>
struct CellCut {
  std::vector<Polytope<dim>> pieces; ///< convex, disjoint interiors, their union is the fluid of the cell
  std::vector<int> part_of_piece;    ///< connected part, 0 .. part_count - 1, ordered by first piece
  int part_count = 0;
  std::vector<Polytope<dim>> removed; ///< convex, disjoint interiors, their union is the solid of the cell
};

/// Takes the solid cells (those whose boxes touch the cell are enough) out of a background cell. Pieces that
/// share a piece of positive measure of a facet are of one part. Each piece keeps in `sides` the skin it lies
/// against.
template <int dim>
CellCut<dim> cut_cell(const HyperplaneTable<dim>& table, int cell, std::span<const SolidCell> solid_cells);

/// Whether two pieces of one cell share a piece of positive measure of a facet.
template <int dim>
bool share_facet(const Polytope<dim>& a, const Polytope<dim>& b, const HyperplaneTable<dim>& table);

} // namespace undula::geometry
