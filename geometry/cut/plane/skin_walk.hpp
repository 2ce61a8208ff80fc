// The skin of the solids traced through the background, cell by cell, in floating point. Every decision is a
// sign of input points with a bound of its rounding error; where one is uncertain, the cells around are
// handed to exact arithmetic.
#pragma once

#include <span>
#include <vector>

#include "geometry/cut/plane/solid_skin.hpp"
#include "geometry/mesh/box_grid.hpp"

namespace undula::geometry {

/// What can be known of the background before the solids are placed. The views must outlive it.
class BackgroundIndex {
public:
  /// Throws NumericsError if a cell is flat or inverted.
  BackgroundIndex(const SimplexMesh<2>& mesh, const FacetTable<2>& facets);

  const SimplexMesh<2>& mesh() const { return *mesh_; }
  const FacetTable<2>& facets() const { return *facets_; }
  const BoxGrid<2>& cell_grid() const { return cell_grid_; }

  /// Ends of a facet in the order of their coordinates, so that results do not depend on numbers.
  int low(int facet) const { return ends_[facet][0]; }
  int high(int facet) const { return ends_[facet][1]; }
  /// Whether low -> high runs counter-clockwise around cell k of the facet.
  bool forward(int facet, int k) const { return (forward_[facet] != 0) == (k == 0); }

  /// Boundary facets whose boxes touch the box.
  std::vector<int> boundary_near(const Box<2>& box) const;

  /// [point], [point + 1): range in facets_of_points.
  std::vector<int> first_facet_of_point;
  std::vector<int> facets_of_points;

private:
  const SimplexMesh<2>* mesh_;
  const FacetTable<2>* facets_;
  std::vector<std::array<int, 2>> ends_;
  std::vector<char> forward_;
  BoxGrid<2> cell_grid_, boundary_grid_;
  std::vector<int> boundary_facets_;
};

/// Where a segment of the skin passes through a background facet.
struct SkinCrossing {
  int facet = -1;
  int into = 0;             ///< side of the facet (index into Facet::cells) to which the segment goes on
  double t = 0, error = 0;  ///< position from low (0) to high (1), and the bound of its error
  Point<2> x;               ///< cm
  bool fluid_after = false; ///< whether there is fluid on the facet beyond t
  int chain = -1;           ///< chain that starts here, -1 outside of the background
};

/// The part of one segment in one cell.
struct SkinPiece {
  int segment = -1;
  Point<2> from, to; ///< cm
  int next = -1;     ///< piece that follows in the chain
};

/// A line of pieces through a cell, from crossing to crossing.
struct SkinChain {
  int cell = -1;
  int entry = -1, exit = -1; ///< crossings
  int first = -1, last = -1; ///< pieces
  int next_in_cell = -1;
};

struct SkinTrace {
  std::vector<SkinCrossing> crossings;
  std::vector<int> facet_crossings; ///< [facet], [facet + 1): range in `sorted`
  std::vector<int> sorted;          ///< crossings by facet, from low to high
  std::vector<SkinPiece> pieces;
  std::vector<SkinChain> chains;
  std::vector<int> first_chain; ///< by cell, -1 if none
  std::vector<char> uncertain;  ///< by cell: to be decided in exact arithmetic

  int count(int facet) const { return facet_crossings[facet + 1] - facet_crossings[facet]; }
  /// Crossing i of a facet, from low to high.
  const SkinCrossing& at(int facet, int i) const { return crossings[sorted[facet_crossings[facet] + i]]; }
};

/// Around cells that are not uncertain, every chain has both its crossings, and the order of crossings on
/// facets is certain. `touching` are segments whose surroundings are uncertain (see touching_segments).
SkinTrace trace_skin(const BackgroundIndex& background, const SolidSkin& skin,
                     std::span<const PlacedSegment> placed, std::span<const int> touching);

} // namespace undula::geometry
