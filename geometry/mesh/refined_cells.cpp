#include "geometry/mesh/refined_cells.hpp"

#include <cmath>

namespace undula::geometry {
namespace {

// Flatter than the boundary turns from facet to facet, and thinner than the worst of other cells.
constexpr double turn = 0.94; // cosine between the normals of the two facets
constexpr double flat = 0.02; // volume over the cube of the longest edge; a regular cell has 0.12

bool peel_once(SimplexMesh<3>& mesh) {
  const auto table = build_facet_table(mesh);
  std::vector<char> gone(mesh.cells.size(), 0);
  for (int c = 0; c < static_cast<int>(mesh.cells.size()); ++c) {
    if (cell_measure(mesh, c) > flat * std::pow(cell_diameter(mesh, c), 3)) continue;
    std::vector<int> outside;
    bool beside_gone = false;
    for (int k = 0; k < 4; ++k) {
      const auto& facet = table.facets[table.cell_facets[c][k]];
      if (facet.cells[1] < 0)
        outside.push_back(k);
      else
        beside_gone = beside_gone || gone[facet.cells[0]] || gone[facet.cells[1]];
    }
    if (outside.size() != 2 || beside_gone) continue;
    const auto gradients = barycentric_gradients(mesh, c);
    gone[c] = gradients.col(outside[0]).normalized().dot(gradients.col(outside[1]).normalized()) > turn;
  }
  std::size_t kept = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    if (!gone[c]) mesh.cells[kept++] = mesh.cells[c];
  const bool changed = kept < mesh.cells.size();
  mesh.cells.resize(kept);
  return changed;
}

} // namespace

void peel_flat_cells(SimplexMesh<3>& mesh) {
  while (peel_once(mesh)) {
  }
}

} // namespace undula::geometry
