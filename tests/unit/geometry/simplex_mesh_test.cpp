#include "geometry/mesh/simplex_mesh.hpp"

#include <gtest/gtest.h>

#include "rom/base/error.hpp"

namespace undula::geometry {
namespace {

SimplexMesh<2> two_triangles() {
  SimplexMesh<2> mesh;
  mesh.points = {{0, 0}, {2, 0}, {2, 1}, {0, 1}};
  mesh.cells = {{0, 1, 2}, {2, 3, 0}};
  mesh.boundary_names = {"bottom", "top"};
  mesh.boundary = {{{1, 0}, 0}, {{2, 3}, 1}};
  return mesh;
}

SimplexMesh<3> one_tetrahedron() {
  SimplexMesh<3> mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
  mesh.cells = {{0, 1, 2, 3}};
  return mesh;
}

TEST(SimplexMesh, FacetTableKnowsBothSidesAndTheTags) {
  const auto mesh = two_triangles();
  const auto table = build_facet_table(mesh);
  ASSERT_EQ(table.facets.size(), 5u);
  int inner = 0;
  for (std::size_t f = 0; f < table.facets.size(); ++f) {
    const auto& facet = table.facets[f];
    EXPECT_LT(facet.points[0], facet.points[1]);
    for (int k = 0; k < 2 && facet.cells[k] >= 0; ++k) {
      EXPECT_EQ(table.cell_facets[facet.cells[k]][facet.local[k]], static_cast<int>(f));
      const int opposite = mesh.cells[facet.cells[k]][facet.local[k]];
      EXPECT_TRUE(opposite != facet.points[0] && opposite != facet.points[1]);
    }
    if (facet.cells[1] >= 0) {
      ++inner;
      EXPECT_EQ(facet.points, (std::array<int, 2>{0, 2}));
      EXPECT_EQ(facet.cells, (std::array<int, 2>{0, 1}));
    }
    const int tag = facet.points == std::array<int, 2>{0, 1}   ? 0
                    : facet.points == std::array<int, 2>{2, 3} ? 1
                                                               : -1;
    EXPECT_EQ(facet.boundary_tag, tag);
  }
  EXPECT_EQ(inner, 1);
  EXPECT_EQ(build_facet_table(one_tetrahedron()).facets.size(), 4u);
}

TEST(SimplexMesh, FacetWithThreeCellsIsRefused) {
  auto mesh = two_triangles();
  mesh.points.push_back({1, 3});
  mesh.cells.push_back({0, 2, 4});
  EXPECT_THROW(build_facet_table(mesh), InputError);
}

TEST(SimplexMesh, BoundaryFacetInsideTheMeshIsRefused) {
  auto mesh = two_triangles();
  mesh.boundary.push_back({{0, 2}, 0});
  EXPECT_THROW(build_facet_table(mesh), InputError);
  mesh.boundary.back().points = {1, 3};
  EXPECT_THROW(build_facet_table(mesh), InputError);
}

TEST(SimplexMesh, MeasuresAndDiameters) {
  EXPECT_DOUBLE_EQ(cell_measure(two_triangles(), 0), 1);
  EXPECT_DOUBLE_EQ(cell_diameter(two_triangles(), 0), std::sqrt(5.0));
  EXPECT_DOUBLE_EQ(cell_measure(one_tetrahedron(), 0), 1);
  EXPECT_DOUBLE_EQ(cell_diameter(one_tetrahedron(), 0), std::sqrt(13.0));
  auto turned = two_triangles();
  std::swap(turned.cells[0][0], turned.cells[0][1]);
  EXPECT_DOUBLE_EQ(cell_measure(turned, 0), -1);
}

TEST(SimplexMesh, BarycentricCoordinatesReproduceLinearFunctions) {
  const auto mesh = one_tetrahedron();
  const Point<3> slope(2, -1, 0.5);
  Point<3> gradient = Point<3>::Zero();
  const auto gradients = barycentric_gradients(mesh, 0);
  const Point<3> x(0.7, -0.2, 4); // outside: affine there too
  const auto lambda = barycentric_coordinates(mesh, 0, x);
  Point<3> again = Point<3>::Zero();
  for (int i = 0; i < 4; ++i) {
    gradient += slope.dot(mesh.points[i]) * gradients.col(i);
    again += lambda[i] * mesh.points[i];
  }
  EXPECT_NEAR((gradient - slope).norm(), 0, 1e-14);
  EXPECT_NEAR((again - x).norm(), 0, 1e-14);
  EXPECT_NEAR(lambda.sum(), 1, 1e-14);
}

} // namespace
} // namespace undula::geometry
