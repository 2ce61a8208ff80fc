// Where the skin of solids meets the edges and facets of a background, in floating point. Every decision is a
// sign of input points with a bound of its rounding error; where one is uncertain, the cells around are
// handed to exact arithmetic.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "geometry/cut/space/skin_surface.hpp"
#include "geometry/cut/space/space_index.hpp"

namespace undula::geometry {

/// A corner of the skin's part in a cell: where a triangle meets an edge of the background, where an edge of
/// the skin meets a facet, or a point of the skin.
struct SkinNode {
  enum class Kind { edge_crossing, facet_crossing, point };
  Kind kind;
  int index;
  bool operator==(const SkinNode&) const = default;
};

/// A triangle of the skin meets an edge of the background.
struct EdgeCrossing {
  int edge = -1, triangle = -1;
  double t = 0, error = 0;  ///< position from low (0) to high (1), and the bound of its error
  Point<3> x;               ///< cm
  bool fluid_after = false; ///< whether there is fluid on the edge beyond t
};

/// An edge of the skin meets a facet of the background.
struct FacetCrossing {
  int facet = -1, skin_edge = -1;
  double error = 0; ///< of the position, in parts of the facet's size
  Point<3> x;       ///< cm
};

/// What a triangle of the skin shares with a facet of the background.
struct FacetSegment {
  int facet = -1, triangle = -1;
  std::array<SkinNode, 2> ends;
};

struct SurfaceTrace {
  std::vector<EdgeCrossing> edge_crossings; ///< by edge, from low to high
  std::vector<int> first_on_edge;           ///< [edge], [edge + 1): range in edge_crossings
  std::vector<FacetCrossing> facet_crossings;
  std::vector<int> first_on_facet; ///< [facet], [facet + 1): range in facet_crossings
  std::vector<FacetSegment> segments;
  std::vector<int> first_segment;   ///< [facet], [facet + 1): range in segments
  std::vector<int> points_of_cells; ///< points of the skin that lie inside of a cell
  std::vector<int> first_point;     ///< [cell], [cell + 1): range in points_of_cells
  std::vector<char> uncertain;      ///< by cell: to be decided in exact arithmetic

  int count(int edge) const { return first_on_edge[edge + 1] - first_on_edge[edge]; }
  bool meets(int facet) const { return first_segment[facet + 1] > first_segment[facet]; }
};

/// Around cells that are not uncertain, all signs and the order of crossings on edges are certain. `touching`
/// are triangles whose surroundings are uncertain (see touching_triangles).
SurfaceTrace trace_surface(const SpaceIndex& background, const SkinSurface& skin,
                           std::span<const Point<3>> placed, std::span<const int> touching);

/// Beside cells in exact arithmetic crossings have to be good; marks cells until they are.
void spread_uncertainty(const SpaceIndex& background, SurfaceTrace& trace);

} // namespace undula::geometry
