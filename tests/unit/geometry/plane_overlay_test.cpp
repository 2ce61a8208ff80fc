// Regions laid over one another: areas, parts that hang together, borders.
#include "geometry/mesh/plane_overlay.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geometry/mesh/mesh_estimate.hpp"
#include "geometry/mesh/mesh_quality.hpp"
#include "geometry/mesh/polygon_mesh.hpp"
#include "geometry/mesh/polygons.hpp"
#include "geometry/mesh/sized_segments.hpp"

namespace undula::geometry {
namespace {

PlaneRegion box(double left, double low, double right, double high) {
  return polygon_sides({{left, low}, {right, low}, {right, high}, {left, high}});
}

PlaneRegion disc(double x, double y, double radius, int corners = 100) {
  std::vector<Point<2>> points;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / corners;
    points.emplace_back(x + radius * std::cos(angle), y + radius * std::sin(angle));
  }
  return polygon_sides(points);
}

double area_in(const PlaneOverlay& overlay, const std::vector<char>& inside) {
  double sum = 0;
  for (const auto& part : overlay.parts)
    if (part.inside == inside) sum += part.area;
  return sum;
}

TEST(PlaneOverlay, AreasOfWhatTwoBoxesShare) {
  const auto overlay = lay_over({box(0, 0, 4, 2), box(3, 1, 5, 3)});
  EXPECT_NEAR(area_in(overlay, {1, 0}), 7, 1e-12);
  EXPECT_NEAR(area_in(overlay, {1, 1}), 1, 1e-12);
  EXPECT_NEAR(area_in(overlay, {0, 1}), 3, 1e-12);
  EXPECT_EQ(overlay.parts.size(), 3u);
}

TEST(PlaneOverlay, AWallDividesWhatItCrosses) {
  for (const bool gap : {false, true}) {
    const auto overlay = lay_over({box(0, 0, 4, 2), box(1.9, gap ? 0.1 : -1.0, 2.1, 3)});
    int parts = 0;
    for (const auto& part : overlay.parts) parts += part.only_in(0) ? 1 : 0;
    EXPECT_EQ(parts, gap ? 1 : 2);
  }
}

TEST(PlaneOverlay, EdgesThatCoincideBoundNothingTwice) {
  // The second box lies along the whole left side, and covers half of the lower one.
  const auto overlay = lay_over({box(0, 0, 4, 2), box(-1, 0, 2, 0.5)});
  for (const auto& part : overlay.parts) {
    if (!part.only_in(0)) continue;
    EXPECT_NEAR(part.area, 7, 1e-12);
    EXPECT_NEAR(part.borders.at({0, 0}), 2, 1e-12);   // lower side, from x = 2
    EXPECT_NEAR(part.borders.at({0, 3}), 1.5, 1e-12); // left side, above the second box
    EXPECT_NEAR(part.borders.at({0, 1}), 2, 1e-12);
  }
}

TEST(PlaneOverlay, HolesAndRoundShapesKeepTheirAreas) {
  auto plate = box(0, 0, 10, 10);
  for (const auto& edge : disc(5, 5, 2)) plate.push_back(edge);
  const double hole = 0.5 * 100 * 4 * std::sin(2 * std::numbers::pi / 100);
  const auto overlay = lay_over({plate, disc(5, 5, 3)});
  EXPECT_NEAR(area_in(overlay, {1, 0}) + area_in(overlay, {1, 1}), 100 - hole, 1e-10);
  EXPECT_NEAR(area_in(overlay, {0, 1}), hole, 1e-10);
  double pieces = 0;
  for (const auto& piece : overlay.pieces) {
    const auto& x = piece.corners;
    pieces += 0.5 * (x[2].y() - x[1].y()) * (x[1].x() - x[0].x() + x[2].x() - x[3].x());
  }
  EXPECT_NEAR(pieces, 100, 1e-10);
}

TEST(CellEstimate, IsThatOfTheMeshToAThird) {
  // Even sizes, and sizes that grow from a corner.
  for (const double growth : {0.0, 0.2}) {
    const auto size = [&](const Point<2>& x) { return 0.1 + growth * x.norm(); };
    TaggedPolygon polygon;
    polygon.points = {{0, 0}, {4, 0}, {4, 3}, {0, 3}};
    polygon.tags = {0, 0, 0, 0};
    polygon.names = {"side"};
    const auto overlay = lay_over({polygon_sides(polygon.points)});
    const auto estimate = estimate_cells(
        overlay.pieces,
        [&](const Point<2>& x) {
          return SizeOfSource{size(x), x.x() < 2 ? 0 : 1};
        },
        growth, 2, most_cells);
    const double cells = mesh_quality(mesh_polygon(polygon, size, 25)).cells;
    EXPECT_NEAR(estimate.cells / cells, 1, 0.33) << growth;
    EXPECT_NEAR(estimate.by_source[0] + estimate.by_source[1], estimate.cells, 1e-9 * estimate.cells);
  }
}

TEST(CellEstimate, StopsWhereThereIsNoEnd) {
  const auto overlay = lay_over({box(0, 0, 100, 100)});
  const auto estimate = estimate_cells(
      overlay.pieces,
      [](const Point<2>& x) {
        return SizeOfSource{1e-12 + 0.5 * x.norm(), 0};
      },
      0.5, 1, 1e5);
  EXPECT_GT(estimate.cells, 100); // finite, and in no time
  EXPECT_GT(estimate_cells(
                overlay.pieces,
                [](const Point<2>&) {
                  return SizeOfSource{1e-9, 0};
                },
                0, 1, 1e5)
                .cells,
            1e20);
}

TEST(SizedSegments, AskForTheSameAsTryingAllOfThem) {
  std::vector<SizedSegment> segments;
  unsigned state = 1;
  const auto random = [&] {
    state = 1664525 * state + 1013904223;
    return (state >> 8) / double(1 << 24);
  };
  for (int i = 0; i < 500; ++i) {
    const Point<2> a(10 * random(), 10 * random());
    segments.push_back({{a, a + Point<2>(random(), random())}, 0.01 + random(), i});
  }
  const SizedSegments tree(segments, 0.3);
  for (int i = 0; i < 300; ++i) {
    const Point<2> x(12 * random() - 1, 12 * random() - 1);
    double expected = 1, found = 1;
    for (const auto& one : segments) expected = std::min(expected, one.size + 0.3 * distance(one.segment, x));
    int source = -1;
    tree.lower(x, found, source);
    EXPECT_EQ(found, expected);
  }
}

} // namespace
} // namespace undula::geometry
