#include "geometry/mesh/overlap_volume.hpp"

#include <gtest/gtest.h>

#include "geometry/mesh/box_mesh.hpp"

namespace undula::geometry {
namespace {

std::array<Point<3>, 4> corners(const SimplexMesh<3>& mesh, std::size_t cell) {
  std::array<Point<3>, 4> x;
  for (int i = 0; i < 4; ++i) x[i] = mesh.points[mesh.cells[cell][i]];
  return x;
}

TEST(OverlapVolume, OfTheCellsOfTwoBoxesIsThatOfTheBoxes) {
  const auto a = box_mesh({{0, 0, 0}, {1, 1, 1}}, {2, 1, 2});
  for (const Point<3>& shift : {Point<3>(0.3, 0.2, 0.45), Point<3>(0.5, 0, 0), Point<3>(0, 0, 0),
                                Point<3>(-0.5, 0.5, 1e-12), Point<3>(1, 0, 0), Point<3>(3, 0, 0)}) {
    const auto b = box_mesh({shift, shift + Point<3>(1, 1, 0.75)}, {1, 2, 3});
    double sum = 0;
    for (std::size_t i = 0; i < a.cells.size(); ++i)
      for (std::size_t j = 0; j < b.cells.size(); ++j) sum += overlap_volume(corners(a, i), corners(b, j));
    const Point<3> side = (shift + Point<3>(1, 1, 0.75)).cwiseMin(1) - shift.cwiseMax(0);
    EXPECT_NEAR(sum, side.cwiseMax(0).prod(), 1e-14) << shift.transpose();
  }
}

} // namespace
} // namespace undula::geometry
