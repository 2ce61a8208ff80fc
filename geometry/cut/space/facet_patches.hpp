// The fluid on the facets of a background, as regions between the skin and the edges of the facet.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "geometry/cut/space/surface_trace.hpp"
#include "geometry/mesh/quadrature.hpp"

namespace undula::geometry {

/// A stretch of an edge of the background between neighbouring crossings, counted from its low end.
struct EdgeStretch {
  int edge = -1;
  int index = 0;
};

/// A connected region of fluid on a facet that the skin meets.
struct FacetPatch {
  double area = 0;               ///< cm^2
  std::vector<Point<3>> outline; ///< cm, counter-clockwise around the facet's points, in their order
  std::vector<std::vector<Point<3>>> holes; ///< cm
  std::vector<int> segments;          ///< of the skin that bound it, indices into SurfaceTrace::segments
  std::vector<EdgeStretch> stretches; ///< of the edges that bound it
  std::array<int, 2> parts{-1, -1};   ///< on either side of the facet, to be filled in
};

/// Walks along the edges of a facet and the skin, fluid always on one side. Nothing if fluid and solid do not
/// take turns around the facet, or rounding hides which loop lies in which.
std::optional<std::vector<FacetPatch>> find_patches(const SpaceIndex& background, const SkinSurface& skin,
                                                    std::span<const Point<3>> placed,
                                                    const SurfaceTrace& trace, int facet);

/// Whether a point of the facet's plane lies in the patch.
bool patch_contains(const FacetPatch& patch, const Point<3>& normal, const Point<3>& x);

/// Appends the rule for a patch without holes. False, with nothing appended, if its corners do not allow a
/// triangulation in floating point.
bool append_patch_quadrature(const FacetPatch& patch, const ReferenceRule<2>& rule, QuadratureSet<3>& set);

/// Twice the area vector of a closed polygon, cm^2, relative to its first corner.
Point<3> twice_area(const std::vector<Point<3>>& polygon);

} // namespace undula::geometry
