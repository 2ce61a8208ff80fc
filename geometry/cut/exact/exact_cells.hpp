// Cells of the background near solids, cut in exact arithmetic.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "geometry/cut/cut_setup.hpp"
#include "geometry/cut/exact/cut_cell.hpp"

namespace undula::geometry {

/// What a fluid part leaves on a facet of its cell, convex.
template <int dim>
struct FacetTrace {
  int part; ///< of the cell, from 0
  Polytope<dim> shape;
};

template <int dim>
struct ExactCell {
  int cell;
  std::vector<SolidCell> solid_cells; ///< near
  CellCut<dim> shape;
  std::array<std::vector<FacetTrace<dim>>, dim + 1> traces; ///< by opposite vertex
};

/// The cells that one cut of the background does in exact arithmetic. Planes and search grid are made on
/// first use.
template <int dim>
class ExactCells {
public:
  using Setup = typename BackgroundCutter<dim>::Setup;

  /// Both have to outlive this.
  ExactCells(const Setup& setup, std::span<const SimplexMesh<dim>> solids);

  bool has(int cell) const { return index_[cell] >= 0; }
  const ExactCell<dim>& at(int cell) const { return cells_[index_[cell]]; }
  int count() const { return static_cast<int>(cells_.size()); }

  /// Cuts a cell that it has not yet.
  void cut(int cell);

  /// Solid cells whose boxes touch the cell's.
  std::vector<SolidCell> near_solid_cells(int cell);

  /// Hyperplanes of all facets: the background is mesh 0, solid s mesh s + 1.
  const HyperplaneTable<dim>& table();

private:
  const Setup& setup_;
  std::span<const SimplexMesh<dim>> solids_;
  std::optional<HyperplaneTable<dim>> table_;
  std::vector<SolidCell> all_solid_cells_; // in the order of the boxes of the grid
  std::optional<BoxGrid<dim>> grid_;
  std::vector<int> index_; // [cell] -> index into cells_, -1 if it is not cut
  std::vector<ExactCell<dim>> cells_;
};

} // namespace undula::geometry
