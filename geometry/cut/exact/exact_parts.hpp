// What cells cut in exact arithmetic add to a cut.
#pragma once

#include "geometry/cut/exact/exact_cells.hpp"

namespace undula::geometry {

/// Appends the parts of a cell with their skin.
template <int dim>
void add_exact_parts(const ExactCell<dim>& near, const HyperplaneTable<dim>& table,
                     const typename BackgroundCutter<dim>::Setup& setup, CutMesh<dim>& cut);

/// Connects the parts across a facet of which each cell is in exact arithmetic or uncut.
template <int dim>
void connect_exact(int facet, ExactCells<dim>& exact, const typename BackgroundCutter<dim>::Setup& setup,
                   CutMesh<dim>& cut);

/// Appends what the parts of a cell in exact arithmetic, or uncut, leave on a boundary facet. Where a solid
/// lies against the boundary from outside, the fluid meets its skin and not the boundary.
template <int dim>
void add_exact_boundary(int facet, ExactCells<dim>& exact, const typename BackgroundCutter<dim>::Setup& setup,
                        CutMesh<dim>& cut);

} // namespace undula::geometry
