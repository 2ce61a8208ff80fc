// Whether the parts of the elements of a cut add up.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "geometry/cut/exact/exact_cells.hpp"

namespace undula::geometry {

/// Relative; beyond it an element has failed.
constexpr double closure_tolerance = 1e-10;

/// What is wrong with a cell of which the parts measure `sum` together; empty if nothing is. Parts + solid =
/// element, and the solid is the sum of its cells.
template <int dim>
std::string error_of_sum(const ExactCell<dim>& near, double sum,
                         const typename BackgroundCutter<dim>::Setup& setup,
                         std::span<const SimplexMesh<dim>> solids);

/// The first of `cells` with a part that is not closed: the integral of the outward normal over its boundary
/// is not 0.
template <int dim>
std::optional<int> first_open_cell(const CutMesh<dim>& cut,
                                   const typename BackgroundCutter<dim>::Setup& setup,
                                   std::span<const int> cells);

} // namespace undula::geometry
