// The skin of plane solids: closed lines of segments with the solid at their left, and what makes it unfit
// for a cut.
#pragma once

#include <span>
#include <vector>

#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::geometry {

/// An edge of a solid with fluid beyond it, from -> to, the solid at its left.
struct SkinSegment {
  int solid = -1;
  int cell = -1; ///< cell of the solid behind the segment
  int from = -1, to = -1;
  bool pinched = false; ///< one of its ends belongs to more than two segments
};

/// Segments in the order in which they follow each other; a line closes from its last to its first segment.
struct SolidSkin {
  std::vector<SkinSegment> segments;
  std::vector<int> lines; ///< [line], [line + 1): range of segments
};

/// Does not depend on the coordinates of the points. Throws NumericsError if two cells lie on one side of a
/// facet (a folded mesh).
SolidSkin build_solid_skin(std::span<const SimplexMesh<2>> solids, std::span<const FacetTable<2>> facets);

/// A segment where it is placed, cm.
struct PlacedSegment {
  Point<2> a, b;
};
std::vector<PlacedSegment> place_skin(const SolidSkin& skin, std::span<const SimplexMesh<2>> solids);

/// Throws NumericsError if a coordinate of a solid is not a finite number, or a cell is flat or inverted.
template <int dim>
void check_placed_solids(std::span<const SimplexMesh<dim>> solids);

/// Segments that touch another one beyond the points they share by connectivity, ascending. Throws
/// NumericsError if two segments cross by more than 1e-12 of their length; by less, they touch.
std::vector<int> touching_segments(const SolidSkin& skin, std::span<const PlacedSegment> placed);

} // namespace undula::geometry
