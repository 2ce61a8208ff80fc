#include "geometry/wave_pump/clearance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "geometry/mesh/polygons.hpp"
#include "geometry/mesh/sized_segments.hpp"
#include "geometry/wave_pump/membrane_outline.hpp"
#include "rom/base/error.hpp"

namespace undula::geometry {

namespace {

using Segments = std::vector<Segment<2>>;

Point<2> nearest_of(const Segments& segments, const Point<2>& x) {
  Point<2> nearest = segments.front().a;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& segment : segments) {
    const Point<2> y = nearest_point(segment, x);
    if (const double d = (y - x).squaredNorm(); d < least) {
      least = d;
      nearest = y;
    }
  }
  return nearest;
}

Segments open_line(const std::vector<Point<2>>& points) {
  Segments line;
  for (std::size_t i = 1; i < points.size(); ++i) line.push_back({points[i - 1], points[i]});
  return line;
}

Segments operator+(Segments a, const Segments& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

struct Sides {
  explicit Sides(const PumpProfile& profile)
      : housing(open_line(profile.housing.points)),
        stator(open_line(profile.stator.points)),
        membrane(polygon_sides(membrane_outline(profile.membrane).points)),
        magnet(polygon_sides(profile.magnet.points)) {}
  Segments housing, stator, membrane, magnet;
};

/// More of them would be gaps of hundreds of thousands of cells.
constexpr std::size_t most_bridges = 200000;

void bridge(const Segments& line, const Segments& other, double widest, double spacing,
            std::vector<GapBridge>& bridges) {
  for (const auto& segment : line) {
    const double length = (segment.b - segment.a).norm();
    for (double s = 0;;) {
      const Point<2> x = segment.a + (s / length) * (segment.b - segment.a);
      const GapBridge found{x, nearest_of(other, x)};
      if (found.width() < widest) bridges.push_back(found);
      if (bridges.size() > most_bridges)
        throw InputError("a gap of the pump is too narrow for so many elements across it",
                         std::to_string(found.width()) + " cm wide at r = " + std::to_string(x.x()) +
                             ", z = " + std::to_string(x.y()) + " cm",
                         "fewer elements across gaps (mesh.gap_elements), or a wider gap", "mesh sizes");
      if (s >= length) break;
      // The width changes by no more than the way walked, so wide gaps are left in long steps.
      s = std::min(length, s + std::max(spacing * found.width(), found.width() - widest));
    }
  }
}

void check(const PumpMeshSizes& sizes) {
  const auto require = [](bool good, const std::string& name, double seen, const std::string& allowed) {
    if (!good)
      throw InputError("a mesh size makes no sense", std::to_string(seen), name + " " + allowed,
                       "mesh sizes");
  };
  // With fewer, edges from wall to wall could block a channel.
  require(sizes.gap_elements >= 2, "gap_elements", sizes.gap_elements, ">= 2");
  require(sizes.channel_size > 0, "channel_size", sizes.channel_size, "> 0 cm");
  require(sizes.membrane_size > 0, "membrane_size", sizes.membrane_size, "> 0 cm");
  require(sizes.growth >= 0, "growth", sizes.growth, ">= 0");
}

} // namespace

std::vector<GapBridge> gap_bridges(const PumpProfile& profile, double widest, double spacing) {
  const Sides sides(profile);
  std::vector<GapBridge> bridges;
  const auto over = [&](const Segments& a, const Segments& b) {
    bridge(a, b, widest, spacing, bridges);
    bridge(b, a, widest, spacing, bridges);
  };
  over(sides.membrane, sides.housing + sides.stator + sides.magnet);
  over(sides.magnet, sides.housing + sides.stator);
  over(sides.housing, sides.stator);
  return bridges;
}

double local_clearance(const PumpProfile& profile, const Point<2>& x) {
  const Sides sides(profile);
  const double to_wall = (nearest_of(sides.housing + sides.stator, x) - x).norm();
  const double to_skin = (nearest_of(sides.membrane + sides.magnet, x) - x).norm();
  const bool in_solid = inside_outline(sides.membrane, x) || inside_outline(sides.magnet, x);
  return to_wall + (in_solid ? -to_skin : to_skin);
}

std::function<double(const Point<2>&)> pump_size_field(const PumpProfile& profile,
                                                       const PumpMeshSizes& sizes) {
  check(sizes);
  // Bridges half an element apart: between two of them the field rises by growth / 4 of the size at most.
  std::vector<SizedSegment> sources;
  for (const auto& gap :
       gap_bridges(profile, sizes.gap_elements * sizes.channel_size, 0.5 / sizes.gap_elements))
    sources.push_back({{gap.from, gap.to}, gap.width() / sizes.gap_elements, 0});

  return [gaps = SizedSegments(std::move(sources), sizes.growth),
          largest = sizes.channel_size](const Point<2>& x) {
    double size = largest;
    int source = 0;
    gaps.lower(x, size, source);
    return size;
  };
}

} // namespace undula::geometry
