#include <map>
#include <set>

#include "cut_invariants.hpp"

namespace undula::geometry {
namespace {

using namespace test;

Mesh one_triangle() {
  Mesh mesh;
  mesh.points = {{0, 0}, {1, 0}, {0, 1}};
  mesh.cells = {{0, 1, 2}};
  return mesh;
}

TEST(DofSets, OfAnUncutMeshAreItsPoints) {
  const auto cut = cut_mesh<2>(box_mesh(0, 0, 1, 1, 3, 3), {}, {});
  const auto dofs = build_dof_sets(cut);
  ASSERT_EQ(dofs.dof_point.size(), 16u);
  for (int i = 0; i < 16; ++i) EXPECT_EQ(dofs.dof_point[i], i);
  for (std::size_t p = 0; p < cut.parts.size(); ++p)
    EXPECT_EQ(dofs.part_dofs[p], cut.mesh.cells[cut.parts[p].cell]);
}

TEST(DofSets, ThinPlateThroughOneElementGivesTwoParts) {
  const Solids plate{box_mesh(-1, 0.3, 2, 0.31, 6, 1)};
  const auto cut = cut_mesh<2>(one_triangle(), plate, {});
  expect_moments(cut, plate, 1e-12);
  expect_closed(cut, 1e-12);
  ASSERT_EQ(cut.parts.size(), 2u);
  const double below = 0.5 - 0.5 * 0.7 * 0.7;
  const double above = 0.5 * 0.69 * 0.69;
  EXPECT_NEAR(std::min(cut.parts[0].measure, cut.parts[1].measure), above, 1e-14);
  EXPECT_NEAR(std::max(cut.parts[0].measure, cut.parts[1].measure), below, 1e-14);
  const auto dofs = build_dof_sets(cut);
  EXPECT_EQ(dofs.dof_point.size(), 6u);
  for (int i = 0; i < 3; ++i) EXPECT_NE(dofs.part_dofs[0][i], dofs.part_dofs[1][i]);
}

TEST(DofSets, FoldedPlateThroughOneElementGivesThreeParts) {
  // A U lying on its side, folded at x = 2: both legs pass through the element.
  Mesh plate = box_mesh(-1, 0, 2, 1, 5, 5);
  std::erase_if(plate.cells, [&](const auto& cell) {
    const double y = (plate.points[cell[0]][1] + plate.points[cell[1]][1] + plate.points[cell[2]][1]) / 3;
    const double x = (plate.points[cell[0]][0] + plate.points[cell[1]][0] + plate.points[cell[2]][0]) / 3;
    return !((y > 0.2 && y < 0.4) || (y > 0.6 && y < 0.8) || (x > 1.4 && y > 0.2 && y < 0.8));
  });
  plate.boundary.clear();
  const auto cut = cut_mesh<2>(one_triangle(), Solids{plate}, {});
  expect_moments(cut, {plate}, 1e-12);
  expect_closed(cut, 1e-12);
  ASSERT_EQ(cut.parts.size(), 3u);
  std::vector<double> measures;
  for (const auto& part : cut.parts) measures.push_back(part.measure);
  std::sort(measures.begin(), measures.end());
  EXPECT_NEAR(measures[0], 0.5 * 0.2 * 0.2, 1e-14);
  EXPECT_NEAR(measures[1], 0.5 * (0.6 * 0.6 - 0.4 * 0.4), 1e-14);
  EXPECT_NEAR(measures[2], 0.5 * (1 - 0.8 * 0.8), 1e-14);
  const auto dofs = build_dof_sets(cut);
  EXPECT_EQ(dofs.dof_point.size(), 9u);
}

TEST(DofSets, PlateAcrossTheBoxSeparatesTheFluid) {
  const auto cut = cut_mesh<2>(box_mesh(0, 0, 1, 1, 4, 4), Solids{box_mesh(-0.5, 0.6, 1.5, 0.61, 7, 1)}, {});
  const auto dofs = build_dof_sets(cut);
  const auto [below, above] = sides_of(cut, dofs.part_dofs, 0.605);
  for (const int dof : below) EXPECT_FALSE(above.contains(dof)) << "unknown " << dof << " leaks";
  EXPECT_EQ(below.size(), 20u); // rows 0 .. 3
  EXPECT_EQ(above.size(), 15u); // rows 2 .. 4
  EXPECT_EQ(dofs.dof_point.size(), 35u);
}

TEST(DofSets, AroundTheTipOfAPlateTheFluidIsOne) {
  // The tip lies in the element {(0.5, 0.5), (0.75, 0.75), (0.5, 0.75)}; only points wholly behind it are
  // doubled.
  const auto cut = cut_mesh<2>(box_mesh(0, 0, 1, 1, 4, 4), Solids{box_mesh(-0.5, 0.6, 0.55, 0.61, 5, 1)}, {});
  const auto dofs = build_dof_sets(cut);
  std::map<int, int> count;
  for (const int point : dofs.dof_point) ++count[point];
  for (int point = 0; point < 25; ++point) {
    const auto& x = cut.mesh.points[point];
    const bool behind = x[0] < 0.3 && x[1] > 0.4 && x[1] < 0.8;
    EXPECT_EQ(count[point], behind ? 2 : 1) << "point " << x.transpose();
  }
}

TEST(DofSets, PartsThatMeetInAPointOnlyAreSeparate) {
  // Four elements around (0.5, 0.5); two solid ones opposite each other leave two that touch in the point.
  Mesh background;
  background.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0.5}};
  background.cells = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  Solids solids(2);
  for (int s : {0, 1}) {
    solids[s].points = background.points;
    solids[s].cells = {background.cells[2 * s]};
  }
  const auto cut = cut_mesh<2>(background, solids, {});
  ASSERT_EQ(cut.parts.size(), 2u);
  EXPECT_FALSE(cut.parts[0].cut);
  EXPECT_TRUE(cut.connections.empty());
  EXPECT_EQ(build_dof_sets(cut).dof_point.size(), 6u);
  EXPECT_NEAR(summary(cut).interface, 2 * std::numbers::sqrt2, 1e-14);
}

} // namespace
} // namespace undula::geometry
