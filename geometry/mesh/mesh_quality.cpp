#include "geometry/mesh/mesh_quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
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

TetrahedraQuality mesh_quality(const SimplexMesh<3>& mesh) {
  TetrahedraQuality quality;
  if (mesh.cells.empty()) return quality;
  quality.cells = static_cast<int>(mesh.cells.size());
  quality.points = static_cast<int>(mesh.points.size());
  quality.min_angle = 180;
  quality.min_shape = 1;
  quality.shortest_edge = std::numeric_limits<double>::infinity();
  for (int c = 0; c < quality.cells; ++c) {
    const auto& cell = mesh.cells[c];
    const auto gradients = barycentric_gradients(mesh, c);
    double slopes = 0; // of the coordinates; together one over the inner radius
    for (int i = 0; i < 4; ++i) {
      slopes += gradients.col(i).norm();
      for (int j = i + 1; j < 4; ++j) {
        const double cosine = -gradients.col(i).normalized().dot(gradients.col(j).normalized());
        const double angle = std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
        quality.min_angle = std::min(quality.min_angle, angle);
        quality.max_angle = std::max(quality.max_angle, angle);
        const double edge = (mesh.points[cell[i]] - mesh.points[cell[j]]).norm();
        quality.shortest_edge = std::min(quality.shortest_edge, edge);
        quality.longest_edge = std::max(quality.longest_edge, edge);
      }
    }
    // The centre x of the circumscribed sphere: 2 (p_i - p_0) . (x - p_0) = |p_i - p_0|^2.
    Point<3> from_first = Point<3>::Zero();
    for (int i = 1; i < 4; ++i)
      from_first += 0.5 * (mesh.points[cell[i]] - mesh.points[cell[0]]).squaredNorm() * gradients.col(i);
    quality.min_shape = std::min(quality.min_shape, 3 / (slopes * from_first.norm()));
    quality.volume += cell_measure(mesh, c);
  }
  return quality;
}

} // namespace undula::geometry
