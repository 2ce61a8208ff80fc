// What keeps a closed outline from being meshed.
#include "geometry/mesh/outline_faults.hpp"

#include <gtest/gtest.h>

#include "geometry/mesh/polygon_mesh.hpp"
#include "rom/base/error.hpp"

namespace undula::geometry {
namespace {

using Kind = OutlineFault::Kind;
using Corners = std::vector<Point<2>>;

constexpr double smallest = 1e-5;

void expect_fault(const Corners& corners, Kind kind, std::size_t first, std::size_t second) {
  const auto fault = outline_fault(corners, smallest);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->kind, kind);
  EXPECT_EQ(fault->first, first);
  EXPECT_EQ(fault->second, second);
}

TEST(OutlineFaults, SoundOutlinesOfEitherDirectionHaveNone) {
  EXPECT_FALSE(outline_fault({{0, 0}, {4, 0}, {4, 2}, {0, 2}}, smallest));
  EXPECT_FALSE(outline_fault({{0, 0}, {0, 2}, {4, 2}, {4, 0}}, smallest));
  EXPECT_FALSE(outline_fault({{0, 0}, {4, 0}, {4, 2}, {2, 0.1}, {0, 2}}, smallest)); // bends in
  EXPECT_FALSE(outline_fault({{0, 0}, {2, 0}, {4, 0}, {4, 2}}, smallest));           // a corner on a side
}

TEST(OutlineFaults, NameTheCornersAndEdges) {
  expect_fault({{0, 0}, {4, 0}, {4, 2}, {0, 2}, {0, 0}}, Kind::repeated_corner, 0, 4);
  expect_fault({{0, 0}, {4, 0}, {4, 0}, {0, 2}}, Kind::repeated_corner, 1, 2);
  expect_fault({{0, 0}, {4, 2}, {4, 0}, {0, 2}}, Kind::crossing_edges, 0, 2);          // a bow tie
  expect_fault({{0, 0}, {4, 0}, {2, 0}, {0, 2}}, Kind::crossing_edges, 0, 1);          // folds back
  expect_fault({{0, 0}, {4, 0}, {4, 2}, {2, 0}, {0, 2}}, Kind::crossing_edges, 0, 2);  // touches itself
  expect_fault({{0, 0}, {4, 0}, {4, 2}, {2, 1e-7}, {0, 2}}, Kind::narrow_place, 0, 2); // all but that
  expect_fault({{0, 0}, {4, 0}, {4, 1e-7}, {0, 2}}, Kind::narrow_place, 1, 1);
}

TEST(OutlineFaults, PolygonsThatAreTooNarrowAreNotMeshed) {
  TaggedPolygon polygon;
  polygon.points = {{0, 0}, {1, 0}, {1, 1e-8}, {0.5, 0.5}, {0, 1}};
  polygon.tags.assign(5, 0);
  polygon.names = {"side"};
  const auto mesh = [&](double size) {
    return mesh_polygon(
        polygon, [size](const Point<2>&) { return size; }, 25);
  };
  EXPECT_THROW(mesh(0.1), InputError);
  polygon.points[2].y() = 0.1;
  EXPECT_NO_THROW(mesh(0.1));
}

} // namespace
} // namespace undula::geometry
