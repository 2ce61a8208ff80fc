#include "geometry/wave_pump/wall_ray.hpp"

#include <algorithm>

namespace undula::geometry {

std::optional<WallOnRay> first_wall(const FluidOutline& outline, double r, double z, bool up) {
  std::optional<WallOnRay> nearest;
  for (std::size_t i = 0; i < outline.points.size(); ++i) {
    const Point<2>& a = outline.points[i];
    const Point<2>& b = outline.points[(i + 1) % outline.points.size()];
    if (a.x() == b.x() || r < std::min(a.x(), b.x()) || r > std::max(a.x(), b.x())) continue;
    const double at = a.y() + (r - a.x()) / (b.x() - a.x()) * (b.y() - a.y());
    if (up ? at <= z : at >= z) continue;
    if (!nearest || (up ? at < nearest->z : at > nearest->z)) nearest = WallOnRay{at, outline.curves[i]};
  }
  return nearest;
}

} // namespace undula::geometry
