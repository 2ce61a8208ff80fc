#include "geometry/mesh/mesh_quality.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace undula::geometry {

MeshQuality mesh_quality(const SimplexMesh<2>& mesh) {
  MeshQuality quality;
  if (mesh.cells.empty()) return quality;
  quality.cells = static_cast<int>(mesh.cells.size());
  quality.points = static_cast<int>(mesh.points.size());
  quality.min_angle = 180;
  quality.shortest_edge = std::numeric_limits<double>::infinity();
  for (const auto& cell : mesh.cells)
    for (int i = 0; i < 3; ++i) {
      const Point<2> a = mesh.points[cell[(i + 1) % 3]] - mesh.points[cell[i]];
      const Point<2> b = mesh.points[cell[(i + 2) % 3]] - mesh.points[cell[i]];
      const double cross = a.x() * b.y() - a.y() * b.x();
      const double angle = std::atan2(std::abs(cross), a.dot(b)) * 180 / std::numbers::pi;
      quality.min_angle = std::min(quality.min_angle, angle);
      quality.max_angle = std::max(quality.max_angle, angle);
      quality.shortest_edge = std::min(quality.shortest_edge, a.norm());
      quality.longest_edge = std::max(quality.longest_edge, a.norm());
      if (i == 0) quality.area += 0.5 * cross;
    }
  return quality;
}

} // namespace undula::geometry
