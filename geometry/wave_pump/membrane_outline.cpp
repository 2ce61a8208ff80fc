#include "geometry/wave_pump/membrane_outline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace undula::geometry {
namespace {

constexpr double widest_chord = std::numbers::pi / 8;

/// Radii where a side has a point, ascending.
std::vector<double> breaks(const MembraneProfile& membrane) {
  std::vector<double> radii;
  for (const auto& point : membrane.thickness.points) radii.push_back(point.x());
  radii.push_back(membrane.clamp_radius);
  std::sort(radii.begin(), radii.end());
  radii.erase(std::unique(radii.begin(), radii.end()), radii.end());
  return radii;
}

Point<2> on_side(const MembraneProfile& membrane, double r, double side) {
  return {r, membrane.mid_plane + side * 0.5 * membrane_thickness(membrane, r)};
}

/// Angle between the two sides of a corner.
double corner_angle(const Point<2>& before, const Point<2>& corner, const Point<2>& after) {
  const Point<2> a = (before - corner).normalized(), b = (after - corner).normalized();
  return std::acos(std::clamp(a.dot(b), -1.0, 1.0));
}

/// The arc of that radius in the place of a corner, from the side before to the side after, ends included.
std::vector<Point<2>> arc(const Point<2>& before, const Point<2>& corner, const Point<2>& after,
                          double radius) {
  const double half = 0.5 * corner_angle(before, corner, after), turn = std::numbers::pi - 2 * half;
  const Point<2> a = (before - corner).normalized(), b = (after - corner).normalized();
  const Point<2> centre = corner + radius / std::sin(half) * (a + b).normalized();
  const Point<2> start = corner + radius / std::tan(half) * a - centre;
  const double sense = a.x() * b.y() - a.y() * b.x() < 0 ? 1 : -1; // a convex corner turns to the left
  const int chords = std::max(1, static_cast<int>(std::ceil(turn / widest_chord - 1e-9)));
  std::vector<Point<2>> points;
  for (int k = 0; k <= chords; ++k) {
    const double angle = sense * turn * k / chords, c = std::cos(angle), s = std::sin(angle);
    points.emplace_back(centre.x() + c * start.x() - s * start.y(),
                        centre.y() + s * start.x() + c * start.y());
  }
  return points;
}

double largest_radius(const MembraneProfile& membrane, double end, double next) {
  const Point<2> corner = on_side(membrane, end, -1), along = on_side(membrane, next, -1);
  const double half = 0.5 * corner_angle(along, corner, on_side(membrane, end, 1));
  // A piece of the end and of the side stays straight, no shorter than elements can be.
  return 0.9 * std::tan(half) * std::min(0.5 * membrane_thickness(membrane, end), (along - corner).norm());
}

} // namespace

double largest_tip_radius(const MembraneProfile& membrane) {
  const auto radii = breaks(membrane);
  return largest_radius(membrane, radii.front(), radii[1]);
}

double largest_rim_radius(const MembraneProfile& membrane) {
  const auto radii = breaks(membrane);
  return largest_radius(membrane, radii.back(), radii[radii.size() - 2]);
}

MembraneOutline membrane_outline(const MembraneProfile& membrane) {
  using Side = MembraneOutline::Side;
  const auto radii = breaks(membrane);
  const double tip = radii.front(), rim = radii.back();
  MembraneOutline outline;
  const auto add = [&](const Point<2>& point, Side side) {
    outline.points.push_back(point);
    outline.sides.push_back(side);
  };
  const auto add_corner = [&](double end, double next, double radius, double side, bool leaves,
                              Side on_side_of, Side on_end) {
    const Point<2> corner = on_side(membrane, end, side), along = on_side(membrane, next, side),
                   across = on_side(membrane, end, -side);
    if (radius <= 0) {
      add(corner, leaves ? on_side_of : on_end);
      return;
    }
    const auto points = leaves ? arc(across, corner, along, radius) : arc(along, corner, across, radius);
    for (std::size_t k = 0; k < points.size(); ++k)
      add(points[k], leaves && k + 1 == points.size() ? on_side_of : on_end);
  };
  const auto add_side = [&](double side, Side name, int& clamp) {
    for (std::size_t k = 1; k + 1 < radii.size(); ++k) {
      const double r = side < 0 ? radii[k] : radii[radii.size() - 1 - k];
      if (r == membrane.clamp_radius) clamp = static_cast<int>(outline.points.size());
      add(on_side(membrane, r, side), name);
    }
  };
  add_corner(tip, radii[1], membrane.tip_radius, -1, true, Side::lower, Side::tip);
  add_side(-1, Side::lower, outline.clamp[0]);
  add_corner(rim, radii[radii.size() - 2], membrane.rim_radius, -1, false, Side::lower, Side::rim);
  add_corner(rim, radii[radii.size() - 2], membrane.rim_radius, 1, true, Side::upper, Side::rim);
  add_side(1, Side::upper, outline.clamp[1]);
  add_corner(tip, radii[1], membrane.tip_radius, 1, false, Side::upper, Side::tip);
  return outline;
}

} // namespace undula::geometry
