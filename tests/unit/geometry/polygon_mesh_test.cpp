#include "geometry/mesh/polygon_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "geometry/mesh/mesh_quality.hpp"
#include "rom/base/error.hpp"

namespace undula::geometry {
namespace {

/// An L of area 3 with a line across.
TaggedPolygon l_shape() {
  TaggedPolygon polygon;
  polygon.points = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  polygon.tags = {0, 1, 0, 2, 0, 1};
  polygon.names = {"flat", "upright", "inner"};
  polygon.inner_lines = {{0, 3}};
  return polygon;
}

SizeField constant(double h) {
  return [h](const Point<2>&) { return h; };
}

std::map<std::array<int, 2>, int> directed_edges(const SimplexMesh<2>& mesh) {
  std::map<std::array<int, 2>, int> edges;
  for (const auto& cell : mesh.cells)
    for (int i = 0; i < 3; ++i) ++edges[{cell[i], cell[(i + 1) % 3]}];
  return edges;
}

TEST(PolygonMesh, FillsThePolygonByConformingCells) {
  const auto mesh = mesh_polygon(l_shape(), constant(0.1), 25);
  const auto quality = mesh_quality(mesh);
  EXPECT_NEAR(quality.area, 3, 1e-13);
  EXPECT_GE(quality.min_angle, 25);
  EXPECT_LE(quality.longest_edge, 0.1 * 4 / 3);
  EXPECT_GT(quality.longest_edge, 0.1);
  int boundary = 0;
  const auto edges = directed_edges(mesh);
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1); // positively oriented cells meet edge against edge
    boundary += !edges.contains({edge[1], edge[0]});
  }
  EXPECT_EQ(boundary, static_cast<int>(mesh.boundary.size()));
  EXPECT_EQ(mesh.points.size() + mesh.cells.size(),
            edges.size() - (edges.size() - boundary) / 2 + 1); // Euler
}

TEST(PolygonMesh, TagsTheBoundaryBySides) {
  const auto mesh = mesh_polygon(l_shape(), constant(0.3), 25);
  std::array<double, 3> length{};
  for (const auto& facet : mesh.boundary)
    length[facet.tag] += (mesh.points[facet.points[1]] - mesh.points[facet.points[0]]).norm();
  EXPECT_NEAR(length[0], 2 + 1 + 1, 1e-14);
  EXPECT_NEAR(length[1], 1 + 2, 1e-14);
  EXPECT_NEAR(length[2], 1, 1e-14);
  EXPECT_EQ(mesh.boundary_names, l_shape().names);
}

TEST(PolygonMesh, KeepsInnerLinesAsEdges) {
  const auto mesh = mesh_polygon(l_shape(), constant(0.2), 25);
  double length = 0;
  for (const auto& [edge, count] : directed_edges(mesh)) {
    const auto& a = mesh.points[edge[0]];
    const auto& b = mesh.points[edge[1]];
    if (edge[0] < edge[1] && std::abs(a.x() - a.y()) < 1e-12 && std::abs(b.x() - b.y()) < 1e-12)
      length += (b - a).norm();
  }
  EXPECT_NEAR(length, std::numbers::sqrt2, 1e-12);
}

TEST(PolygonMesh, FollowsTheSizeField) {
  const auto size = [](const Point<2>& x) { return 0.02 + 0.1 * x.y(); };
  const auto mesh = mesh_polygon(l_shape(), size, 25);
  double least = 1, greatest = 0;
  for (const auto& cell : mesh.cells) {
    double longest = 0;
    Point<2> middle = Point<2>::Zero();
    for (int i = 0; i < 3; ++i) {
      longest = std::max(longest, (mesh.points[cell[i]] - mesh.points[cell[(i + 1) % 3]]).norm());
      middle += mesh.points[cell[i]] / 3;
    }
    EXPECT_LE(longest, 4.0 / 3 * size(middle) * (1 + 1e-12));
    least = std::min(least, longest);
    greatest = std::max(greatest, longest);
  }
  EXPECT_LT(least, 0.04);
  EXPECT_GT(greatest, 0.15);
}

TEST(PolygonMesh, IsReproducibleAndLocal) {
  const auto one = mesh_polygon(l_shape(), constant(0.05), 25);
  const auto two = mesh_polygon(l_shape(), constant(0.05), 25);
  EXPECT_EQ(one.points, two.points);
  EXPECT_EQ(one.cells, two.cells);
  // Along a Hilbert curve most neighbours are close in number; in a random order the mean would be points
  // / 3.
  double distance = 0;
  const auto edges = directed_edges(one);
  for (const auto& [edge, count] : edges) distance += std::abs(edge[0] - edge[1]);
  EXPECT_LT(distance / edges.size(), 0.08 * one.points.size());
}

TEST(PolygonMesh, RefusesPolygonsItCannotMesh) {
  auto clockwise = l_shape();
  std::reverse(clockwise.points.begin(), clockwise.points.end());
  EXPECT_THROW(mesh_polygon(clockwise, constant(0.1), 25), InputError);
  auto crossing = l_shape();
  std::swap(crossing.points[1], crossing.points[2]);
  EXPECT_THROW(mesh_polygon(crossing, constant(0.1), 25), InputError);
  auto untagged = l_shape();
  untagged.tags.pop_back();
  EXPECT_THROW(mesh_polygon(untagged, constant(0.1), 25), InputError);
}

/// A square of area 4 with a square hole of area 0.25 and a round one of 32 corners.
TaggedPolygon with_holes(bool clockwise) {
  TaggedPolygon polygon;
  polygon.points = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
  polygon.tags = {0, 0, 0, 0};
  polygon.names = {"outside", "square", "round"};
  polygon.holes = {{{{0.25, 0.25}, {0.75, 0.25}, {0.75, 0.75}, {0.25, 0.75}}, 1}, {{}, 2}};
  for (int k = 0; k < 32; ++k) {
    const double angle = 2 * std::numbers::pi * k / 32;
    polygon.holes[1].points.push_back({1.4 + 0.3 * std::cos(angle), 1.4 + 0.3 * std::sin(angle)});
  }
  if (clockwise)
    for (auto& hole : polygon.holes) std::reverse(hole.points.begin(), hole.points.end());
  return polygon;
}

TEST(PolygonMesh, LeavesHolesOutInEitherDirection) {
  const double round = 0.5 * 32 * 0.09 * std::sin(2 * std::numbers::pi / 32);
  for (const bool clockwise : {false, true}) {
    const auto mesh = mesh_polygon(with_holes(clockwise), constant(0.1), 25);
    EXPECT_NEAR(mesh_quality(mesh).area, 4 - 0.25 - round, 1e-12);
    std::array<double, 3> length{};
    const auto edges = directed_edges(mesh);
    for (const auto& facet : mesh.boundary) {
      length[facet.tag] += (mesh.points[facet.points[1]] - mesh.points[facet.points[0]]).norm();
      EXPECT_TRUE(edges.contains(facet.points)); // the domain to the left of its boundary
    }
    EXPECT_NEAR(length[0], 8, 1e-12);
    EXPECT_NEAR(length[1], 2, 1e-12);
    EXPECT_NEAR(length[2], 64 * 0.3 * std::sin(std::numbers::pi / 32), 1e-12);
  }
}

TEST(PolygonMesh, RefusesHolesThatReachOut) {
  auto polygon = with_holes(false);
  polygon.holes[0].points[0] = {-0.1, 0.25};
  EXPECT_THROW(mesh_polygon(polygon, constant(0.1), 25), InputError);
}

TEST(PolygonMesh, KeepsPathsInsideAsEdges) {
  TaggedPolygon polygon;
  polygon.points = {{0, 0}, {2, 0}, {2, 1}, {0, 1}};
  polygon.tags = {0, 0, 0, 0};
  polygon.names = {"side"};
  polygon.inner_paths = {{{0.8, 0}, {0.9, 0.5}, {0.8, 1}}};
  const auto mesh = mesh_polygon(polygon, constant(0.2), 25);
  // No cell has corners on both sides of the path.
  const auto side = [](const Point<2>& x) { return x.x() - (0.9 - 0.2 * std::abs(x.y() - 0.5)); };
  for (const auto& cell : mesh.cells) {
    double low = 0, high = 0;
    for (const int p : cell) {
      low = std::min(low, side(mesh.points[p]));
      high = std::max(high, side(mesh.points[p]));
    }
    EXPECT_TRUE(low > -1e-12 || high < 1e-12);
  }
}

} // namespace
} // namespace undula::geometry
