// Cells of a background in space, cut in floating point: the skin in each, the fluid parts that it bounds,
// and what neighbours share.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/cut/space/convex_fill.hpp"
#include "geometry/cut/space/facet_patches.hpp"

namespace undula::geometry {

/// The skin in a cell, polygon by polygon, and its fluid parts. Reused from cell to cell.
struct FluidBodies {
  struct Polygon {
    int triangle = -1;
    int part = -1;
    ConvexPolygon shape; ///< cm
  };
  std::vector<Polygon> polygons;
  std::vector<double> volumes; ///< by part, from its surface by the divergence theorem, cm^3
  struct Patch {
    int local; ///< facet opposite this vertex
    int index; ///< into the patches of the facet; -1: the facet is all fluid
    int part;
  };
  std::vector<Patch> patches;
};

/// One placement of the solids.
class SpaceCells {
public:
  /// All but the placed points have to outlive this.
  SpaceCells(const SpaceIndex& background, const SkinSurface& skin, std::vector<Point<3>> placed);

  const SurfaceTrace& trace() const { return trace_; }

  /// Of a triangle of the skin, unit, into the solid.
  Point<3> normal(int triangle) const;

  /// Whether the skin passes through a cell that is not uncertain.
  bool is_cut(int cell) const;

  /// Patches of a facet that the skin meets and that has a cell which is not uncertain; null otherwise.
  std::vector<FacetPatch>* patches(int facet) {
    return patch_index_[facet] < 0 ? nullptr : &patches_[patch_index_[facet]];
  }

  /// The fluid parts of a cell, `fluid_at` telling on which side of the skin a point of the background lies.
  /// False if the cell has to be cut in exact arithmetic.
  template <class FluidAt>
  bool find_bodies(int cell, const FluidAt& fluid_at, FluidBodies& bodies) {
    std::array<bool, 4> fluid;
    for (int v = 0; v < 4; ++v) fluid[v] = fluid_at(background_.mesh().cells[cell][v]);
    return find_bodies(cell, fluid, bodies);
  }

  /// Fills the parts by simplices, relative to the first corner of the cell. False if they do not have the
  /// volumes of the parts.
  bool fill(int cell, const FluidBodies& bodies, std::vector<ConvexFill::Simplex>& simplices);

private:
  struct Side; // of a polygon
  bool find_bodies(int cell, const std::array<bool, 4>& fluid, FluidBodies& bodies);
  bool link_polygon(std::span<Side> sides, ConvexPolygon& polygon) const;
  const Point<3>& position(const SkinNode& node) const;

  const SpaceIndex& background_;
  const SkinSurface& skin_;
  std::vector<Point<3>> placed_;
  SurfaceTrace trace_;
  std::vector<int> patch_index_; // [facet] -> index into patches_, -1
  std::vector<std::vector<FacetPatch>> patches_;
  ConvexFill filler_;
  std::vector<SkinPolygon> to_fill_;
};

} // namespace undula::geometry
