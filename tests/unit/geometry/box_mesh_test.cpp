#include "geometry/mesh/box_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "geometry/mesh/mesh_quality.hpp"
#include "rom/base/error.hpp"

namespace undula::geometry {
namespace {

TEST(BoxMesh, FillsTheBoxWithPositiveCellsThatMatch) {
  const auto mesh = box_mesh({{-1, 0, 2}, {1, 3, 2.5}}, {4, 3, 2});
  ASSERT_EQ(mesh.points.size(), 60u);
  ASSERT_EQ(mesh.cells.size(), 144u);
  for (int c = 0; c < 144; ++c) EXPECT_NEAR(cell_measure(mesh, c), 3.0 / 144, 1e-15);
  const auto table = build_facet_table(mesh); // refuses boundary facets that are not on the boundary
  std::map<int, double> area;
  int untagged = 0;
  for (const auto& facet : table.facets) {
    if (facet.cells[1] >= 0) continue;
    untagged += facet.boundary_tag < 0;
    area[facet.boundary_tag] += facet_measure(mesh, facet);
    for (const int p : facet.points) {
      const double wall[6] = {-1, 1, 0, 3, 2, 2.5};
      EXPECT_EQ(mesh.points[p][facet.boundary_tag / 2], wall[facet.boundary_tag]);
    }
  }
  EXPECT_EQ(untagged, 0);
  const double expected[6] = {1.5, 1.5, 1, 1, 6, 6};
  for (int tag = 0; tag < 6; ++tag) EXPECT_NEAR(area[tag], expected[tag], 1e-14);
}

TEST(BoxMesh, RefusesABoxWithoutVolume) {
  EXPECT_THROW(box_mesh({{0, 0, 0}, {1, 0, 1}}, {1, 1, 1}), InputError);
  EXPECT_THROW(box_mesh({{0, 0, 0}, {1, 1, 1}}, {1, 0, 1}), InputError);
}

TEST(TetrahedraQuality, OfARegularCellAndOfKuhnsCube) {
  SimplexMesh<3> regular;
  regular.points = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  regular.cells = {{0, 2, 1, 3}};
  ASSERT_GT(cell_measure(regular, 0), 0);
  const auto quality = mesh_quality(regular);
  EXPECT_NEAR(quality.min_shape, 1, 1e-14);
  EXPECT_NEAR(quality.min_angle, std::acos(1.0 / 3) * 180 / std::acos(-1.0), 1e-12);
  EXPECT_NEAR(quality.max_angle, quality.min_angle, 1e-12);
  EXPECT_NEAR(quality.volume, 8.0 / 3, 1e-14);

  const auto cube = mesh_quality(box_mesh({{0, 0, 0}, {2, 2, 2}}, {2, 2, 2}));
  EXPECT_EQ(cube.cells, 48);
  EXPECT_NEAR(cube.min_angle, 45, 1e-12);
  EXPECT_NEAR(cube.max_angle, 90, 1e-12);
  // Of the unit cell: volume 1/6, surface 1 + sqrt(2), outer radius sqrt(3)/2.
  EXPECT_NEAR(cube.min_shape, 3 * (0.5 / (1 + std::sqrt(2.0))) / (std::sqrt(3.0) / 2), 1e-14);
  EXPECT_NEAR(cube.longest_edge, std::sqrt(3.0), 1e-14);
  EXPECT_NEAR(cube.volume, 8, 1e-13);
}

} // namespace
} // namespace undula::geometry
