// Meshes in space made of meshes in the plane: layers of prisms, each of three tetrahedra.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "geometry/mesh/simplex_mesh.hpp"
#include "tests/verification/support/names.hpp"

namespace undula::verification {

/// The plane mesh over the ascending heights `levels`. Boundary names: its own, then `low` and `high`.
inline SimplexMesh<3> extruded(const SimplexMesh<2>& plane, const std::vector<double>& levels,
                               const std::string& low, const std::string& high) {
  SimplexMesh<3> mesh;
  const int count = static_cast<int>(plane.points.size()), layers = static_cast<int>(levels.size()) - 1;
  for (const double z : levels)
    for (const auto& x : plane.points) mesh.points.emplace_back(x[0], x[1], z);
  const auto add_cell = [&](std::array<int, 4> cell) {
    mesh.cells.push_back(cell);
    if (cell_measure(mesh, static_cast<int>(mesh.cells.size()) - 1) < 0)
      std::swap(mesh.cells.back()[2], mesh.cells.back()[3]);
  };
  mesh.boundary_names = plane.boundary_names;
  const int low_tag = static_cast<int>(mesh.boundary_names.size());
  mesh.boundary_names.push_back(low);
  mesh.boundary_names.push_back(high);
  for (int layer = 0; layer < layers; ++layer) {
    const int base = layer * count, top = base + count;
    // The diagonal of a side starts at its lower point of the smaller number, so that neighbours match.
    for (auto cell : plane.cells) {
      std::sort(cell.begin(), cell.end());
      const auto [a, b, c] = cell;
      add_cell({base + a, base + b, base + c, top + c});
      add_cell({base + a, base + b, top + b, top + c});
      add_cell({base + a, top + a, top + b, top + c});
      if (layer == 0) mesh.boundary.push_back({{a, b, c}, low_tag});
      if (layer == layers - 1) mesh.boundary.push_back({{top + a, top + b, top + c}, low_tag + 1});
    }
    for (const auto& facet : plane.boundary) {
      const auto [a, b] = std::minmax(facet.points[0], facet.points[1]);
      mesh.boundary.push_back({{base + a, base + b, top + b}, facet.tag});
      mesh.boundary.push_back({{base + a, top + a, top + b}, facet.tag});
    }
  }
  return mesh;
}

} // namespace undula::verification
