// The cells of one cut in the plane that are decided in floating point.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "geometry/cut/cut_records.hpp"
#include "geometry/cut/exact/exact_cells.hpp"
#include "geometry/cut/plane/fluid_polygons.hpp"

namespace undula::geometry {

class PlaneCut {
public:
  using Setup = BackgroundCutter<2>::Setup;

  /// Traces the skin. `setup` has to outlive this. Throws NumericsError if skins cross.
  PlaneCut(const Setup& setup, std::span<const SimplexMesh<2>> solids);

  /// By cell: to be cut in exact arithmetic.
  const std::vector<char>& uncertain() const { return trace_.uncertain; }

  // The skin along the edges of the background, which are its facets.
  int edges() const { return static_cast<int>(setup_.facets.facets.size()); }
  int low(int edge) const { return setup_.index->low(edge); }
  int high(int edge) const { return setup_.index->high(edge); }
  /// Crossings of an edge, from low to high.
  int count(int edge) const { return trace_.count(edge); }
  bool fluid_after(int edge, int i) const { return trace_.at(edge, i).fluid_after; }
  /// Cells around an edge, -1 for none.
  std::span<const int> cells(int edge) const { return setup_.facets.facets[edge].cells; }
  std::span<const int> edges_of(int point) const;
  bool meets_facet(int facet) const { return trace_.count(facet) > 0; }
  bool passes_through(int cell) const { return trace_.first_chain[cell] >= 0; }

  /// Appends the parts of a cell. False, with nothing appended, if it has to be cut in exact arithmetic.
  /// Throws CutContradiction.
  bool add_parts(int cell, std::span<const Side> side_of_point, CutMesh<2>& cut);

  /// Connects the parts across a facet, one of whose cells at least is in floating point. Throws
  /// CutContradiction.
  void connect(int facet, const ExactCells<2>& exact, CutMesh<2>& cut);

  /// Appends what the parts leave on a boundary facet.
  void add_boundary(int facet, CutMesh<2>& cut) const;

private:
  void set_stretch(int cell, int local, int index, int part);
  void add_skin(const SkinChain& chain, int part, CutMesh<2>& cut) const;
  int first_stretch(int facet) const { return facet + trace_.facet_crossings[facet]; }
  double stretch_measure(int facet, int index) const;
  std::vector<int> parts_on_stretches(int facet, int k, const ExactCells<2>& exact,
                                      const CutMesh<2>& cut) const;

  const Setup& setup_;
  std::vector<PlacedSegment> placed_;
  SkinTrace trace_;
  std::array<std::vector<int>, 2> stretch_parts_; // [side of facet][stretch] -> part, -1 if solid
  FluidPolygons polygons_;
};

} // namespace undula::geometry
