// The cells of one cut in space that are decided in floating point.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "geometry/cut/cut_records.hpp"
#include "geometry/cut/exact/exact_cells.hpp"
#include "geometry/cut/space/space_cells.hpp"

namespace undula::geometry {

class SpaceCut {
public:
  using Setup = BackgroundCutter<3>::Setup;

  /// Traces the skin. `setup` has to outlive this.
  SpaceCut(const Setup& setup, std::span<const SimplexMesh<3>> solids);

  /// By cell: to be cut in exact arithmetic.
  const std::vector<char>& uncertain() const { return space_.trace().uncertain; }

  // The skin along the edges of the background.
  int edges() const { return static_cast<int>(setup_.space->edges.size()); }
  int low(int edge) const { return setup_.space->edges[edge].low; }
  int high(int edge) const { return setup_.space->edges[edge].high; }
  /// Crossings of an edge, from low to high.
  int count(int edge) const { return space_.trace().count(edge); }
  bool fluid_after(int edge, int i) const {
    return space_.trace().edge_crossings[space_.trace().first_on_edge[edge] + i].fluid_after;
  }
  std::span<const int> cells(int edge) const;
  std::span<const int> edges_of(int point) const;
  bool meets_facet(int facet) const { return space_.trace().meets(facet); }
  bool passes_through(int cell) const { return space_.is_cut(cell); }

  /// Appends the parts of a cell. False, with nothing appended, if it has to be cut in exact arithmetic.
  bool add_parts(int cell, std::span<const Side> side_of_point, CutMesh<3>& cut);

  /// Connects the parts across a facet, one of whose cells at least is in floating point. Throws
  /// CutContradiction.
  void connect(int facet, const ExactCells<3>& exact, CutMesh<3>& cut);

  /// Appends what the parts leave on a boundary facet. Throws CutContradiction if it cannot be filled.
  void add_boundary(int facet, CutMesh<3>& cut);

private:
  void set_part(int cell, int local, int part);
  void add_skin(const FluidBodies::Polygon& polygon, int part, CutMesh<3>& cut) const;
  void find_exact_parts(int facet, int k, const ExactCells<3>& exact, const CutMesh<3>& cut,
                        std::vector<FacetPatch>& patches) const;

  const Setup& setup_;
  SpaceCells space_;
  std::vector<std::array<int, 2>> facet_parts_; // [facet][side] -> part on a facet without skin, -1 if solid
  FluidBodies bodies_;
  std::vector<ConvexFill::Simplex> simplices_;
};

} // namespace undula::geometry
