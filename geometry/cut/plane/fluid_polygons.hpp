// The fluid parts of a background cell as polygons between the skin that passes through it and its facets.
#pragma once

#include <vector>

#include "geometry/cut/plane/skin_walk.hpp"

namespace undula::geometry {

/// Stretch of a facet between two neighbouring crossings.
struct FacetStretch {
  int local = -1; ///< facet opposite this vertex of the cell
  int index = -1; ///< stretch of the facet, counted from its low end
  int polygon = -1;
};

/// A chain of the skin and the polygon it bounds.
struct BoundingChain {
  int chain = -1;
  int polygon = -1;
};

/// Reused from cell to cell.
struct FluidPolygons {
  int count = 0;
  std::vector<std::vector<Point<2>>> corners; ///< [polygon < count], counter-clockwise, cm
  std::vector<FacetStretch> stretches;
  std::vector<BoundingChain> chains;
  double fluid_area = 0, solid_area = 0; ///< cm^2, each by its own outlines
};

/// Walks along chains and facets, fluid always on one side. The order does not depend on numbers, but on the
/// vertices of the cell. False if fluid and solid do not take turns around the cell (solids overlap).
bool find_fluid_polygons(const BackgroundIndex& background, const SkinTrace& trace, int cell,
                         FluidPolygons& polygons);

} // namespace undula::geometry
