// What can be known of a background in space before the solids are placed.
#pragma once

#include <vector>

#include "geometry/mesh/box_grid.hpp"

namespace undula::geometry {

/// Edges of a background and what lies around them. The views must outlive it.
class SpaceIndex {
public:
  /// Throws NumericsError if a cell is flat or inverted.
  SpaceIndex(const SimplexMesh<3>& mesh, const FacetTable<3>& facets);

  const SimplexMesh<3>& mesh() const { return *mesh_; }
  const FacetTable<3>& facets() const { return *facets_; }
  const BoxGrid<3>& cell_grid() const { return cell_grid_; }

  struct Edge {
    int low = -1,
        high = -1; ///< points in the order of their coordinates, so that results do not depend on numbers
  };
  std::vector<Edge> edges;
  std::vector<std::array<int, 6>> cell_edges;  ///< in the order of local_edges<3>()
  std::vector<std::array<int, 3>> facet_edges; ///< edge i joins the points i and i + 1 of the facet
  std::vector<int> positive_cell; ///< by facet: the one (0 or 1) on whose side orientation(facet, .) > 0

  /// [edge], [edge + 1): ranges in cells_of_edges and facets_of_edges.
  std::vector<int> first_cell, cells_of_edges;
  std::vector<int> first_facet, facets_of_edges;
  /// [point], [point + 1): range in edges_of_points.
  std::vector<int> first_edge, edges_of_points;

private:
  const SimplexMesh<3>* mesh_;
  const FacetTable<3>* facets_;
  BoxGrid<3> cell_grid_;
};

} // namespace undula::geometry
