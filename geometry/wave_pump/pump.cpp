#include "geometry/wave_pump/pump.hpp"

#include <algorithm>

#include "geometry/mesh/polygon_mesh.hpp"
#include "geometry/mesh/polygons.hpp"
#include "geometry/wave_pump/membrane_outline.hpp"

namespace undula::geometry {

namespace {

/// Bound of the angles in degrees: above the proven 20.7, with a margin to the 30 where refinement stops to
/// end.
constexpr double min_angle = 25;

} // namespace

SimplexMesh<2> pump_background(const PumpProfile& profile, const PumpMeshSizes& sizes,
                               std::span<const RefinementBox<2>> boxes) {
  const auto outline = fluid_outline(profile);
  TaggedPolygon polygon;
  polygon.points = outline.points;
  polygon.tags.assign(outline.curves.begin(), outline.curves.end());
  polygon.names = {"housing", "stator", "axis", "inlet", "outlet"}; // in the order of FluidOutline::Curve
  const auto by_gaps = pump_size_field(profile, sizes);
  const auto size = [&](const Point<2>& x) {
    double smallest = by_gaps(x);
    for (const auto& box : boxes) smallest = std::min(smallest, size_about(box, sizes.growth, x));
    return smallest;
  };
  return mesh_polygon(polygon, size, min_angle);
}

SimplexMesh<2> pump_membrane(const PumpProfile& profile, const PumpMeshSizes& sizes) {
  const auto& membrane = profile.membrane;
  TaggedPolygon polygon;
  const auto outline = membrane_outline(membrane);
  polygon.points = outline.points;
  polygon.names = {"lower", "rim", "upper", "tip"}; // in the order of MembraneOutline::Side
  polygon.tags.assign(outline.sides.begin(), outline.sides.end());
  polygon.inner_lines.push_back({outline.clamp[0], outline.clamp[1]});

  // No edge exceeds 4/3 of the target, so 3/8 of the thickness keeps two elements across.
  const auto size = [&](const Point<2>& x) {
    return std::min(sizes.membrane_size, 0.375 * membrane_thickness(membrane, x.x()));
  };
  return mesh_polygon(polygon, size, min_angle);
}

SimplexMesh<2> pump_magnet(const PumpProfile& profile, const PumpMeshSizes& sizes) {
  TaggedPolygon polygon;
  polygon.points = profile.magnet.points;
  if (polygon_area(polygon.points) < 0) std::reverse(polygon.points.begin(), polygon.points.end());
  polygon.tags.assign(polygon.points.size(), 0);
  polygon.names = {"magnet"};
  return mesh_polygon(
      polygon, [&](const Point<2>&) { return sizes.membrane_size; }, min_angle);
}

} // namespace undula::geometry
