// Appending to the records of a cut.
#pragma once

#include <array>
#include <cstddef>
#include <numeric>
#include <string>

#include "geometry/cut/cut_mesh.hpp"

namespace undula::geometry {

/// Solids that do not part fluid from solid, as seen in a cell.
struct CutContradiction {
  int cell = -1;
  std::string what = "the skins of solids do not part fluid from solid";
};

/// Which side of the skin a point of the background lies on.
enum class Side : char { unknown, fluid, solid };

/// A cell that is its own part.
template <int dim>
void add_whole(CutMesh<dim>& cut, int cell) {
  cut.parts.push_back({cell, false, cell_measure(cut.mesh, cell)});
}

/// Corners of a facet of the background.
template <int dim>
std::array<Point<dim>, dim> facet_points(const CutMesh<dim>& cut, int facet) {
  std::array<Point<dim>, dim> points;
  for (int i = 0; i < dim; ++i) points[i] = cut.mesh.points[cut.facets.facets[facet].points[i]];
  return points;
}

/// Adds `measure` to what two parts share of a facet, whose connections start at `begin`.
template <int dim>
void add_connection(CutMesh<dim>& cut, std::size_t begin, int facet, std::array<int, 2> parts,
                    double measure) {
  for (std::size_t c = begin; c < cut.connections.size(); ++c) {
    auto& known = cut.connections[c];
    if (known.part[0] != parts[0] || known.part[1] != parts[1]) continue;
    known.measure += measure;
    return;
  }
  cut.connections.push_back({facet, {parts[0], parts[1]}, measure});
}

/// Ends the ranges of a part, whose simplices and rules have been appended, and sums up its measure.
template <int dim>
void close_part(const CutMesh<dim>& cut, FluidPart& part) {
  part.simplex_end = static_cast<int>(cut.simplices.size());
  part.quadrature_end = static_cast<int>(cut.volume_quadrature.weights.size());
  part.measure = std::accumulate(cut.volume_quadrature.weights.begin() + part.quadrature_begin,
                                 cut.volume_quadrature.weights.end(), 0.0);
}

/// Appends the pieces of a boundary facet that parts of its cell touch; `append(part)` appends the rule of
/// one.
template <int dim, class Append>
void add_boundary_pieces(CutMesh<dim>& cut, int index, const Append& append) {
  const auto& facet = cut.facets.facets[index];
  const auto& weights = cut.boundary_quadrature.weights;
  for (int part = cut.cell_parts[facet.cells[0]]; part < cut.cell_parts[facet.cells[0] + 1]; ++part) {
    BoundaryPiece piece{index, part, facet.boundary_tag, static_cast<int>(weights.size()), 0};
    append(part);
    piece.quadrature_end = static_cast<int>(weights.size());
    if (piece.quadrature_end > piece.quadrature_begin) cut.boundary.push_back(piece);
  }
}

} // namespace undula::geometry
