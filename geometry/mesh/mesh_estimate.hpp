// How many cells a size field asks for, before a mesh is made.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "geometry/mesh/plane_overlay.hpp"

namespace undula::geometry {

/// Most cells of all meshes of a problem together. A mesh of more is refused before it is made: a step of it
/// would take minutes, and a size that was misread by a factor of ten asks for a hundred times as many.
inline constexpr int most_cells = 500000;

/// An element size and what asks for it.
struct SizeOfSource {
  double size = 0; ///< cm
  int source = 0;
};

struct CellEstimate {
  double cells = 0;
  std::vector<double> by_source; ///< cells where a source asks for the smallest size
};

/// Mean area of a cell of mesh_polygon, whose edges scatter about the size, in squares of the size.
inline constexpr double mean_cell_area = 0.36;

/// Sum of area / (mean_cell_area size^2) over the pieces. Good to a third where sizes are even and the
/// outline is not narrower than they are. `growth` is the slope of the size. Stops beyond `most` cells; the
/// estimate is then too low.
CellEstimate estimate_cells(std::span<const OverlayPiece> pieces,
                            const std::function<SizeOfSource(const Point<2>&)>& size, double growth,
                            int sources, double most);

} // namespace undula::geometry
