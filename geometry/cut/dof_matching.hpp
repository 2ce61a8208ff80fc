// Which unknown of the last cut continues in the next one.
#pragma once

#include <vector>

#include "geometry/cut/cut_mesh.hpp"

namespace undula::geometry {

/// For each scalar unknown of the cut `now`, the unknown of the cut `before` at the same background point on
/// the same side of the solids; -1 if there is none (the unknown is new). Both are cuts of one background.
///
/// An unknown stands for the set of fluid parts around its point. Two unknowns overlap if, in some background
/// cell, a part of the one set and a part of the other have points in common: quadrature points of either
/// that lie in the other, weighed by their weights, summed over the cells. Solids that move by less than
/// their thickness never sweep a point from one side to the other, so that sides never overlap across a
/// solid. At each background point:
/// - One overlap only: the two unknowns are matched.
/// - One unknown now over several before (a solid's tip has left): the largest overlap wins.
/// - Several now over one before (a tip has entered): the largest overlap wins, the others are new. So every
///   unknown before is matched at most once.
/// - Unknowns chained by overlaps in any other way: a solid has moved by more than its thickness, and
///   nothing of the chain is matched.
/// Ties go to the lowest number. Overlaps cannot tell a solid that jumps out of (or into) all cells around a
/// point by more than its thickness from a tip that leaves (or enters); the caller bounds the motion.
///
/// Throws InputError if the two cuts are not of meshes of the same size.
template <int dim>
std::vector<int> match_dofs(const CutMesh<dim>& before, const DofSets<dim>& dofs_before,
                            const CutMesh<dim>& now, const DofSets<dim>& dofs_now);

} // namespace undula::geometry
