#include <map>
#include <set>

#include "cut_invariants.hpp"

namespace undula::geometry {
namespace {

using namespace test;

TEST(EdgeSets, OfAnUncutMeshAreItsEdges) {
  const auto cut = cut_mesh<2>(box_mesh(0, 0, 1, 1, 3, 3), {}, {});
  const auto edges = build_edge_sets(cut);
  EXPECT_EQ(edges.edge_points.size(), 33u); // 12 + 12 along the axes, 9 diagonals
  constexpr auto local = local_edges<2>();
  for (std::size_t p = 0; p < cut.parts.size(); ++p)
    for (std::size_t e = 0; e < local.size(); ++e) {
      const auto& cell = cut.mesh.cells[cut.parts[p].cell];
      const auto [low, high] = std::minmax(cell[local[e][0]], cell[local[e][1]]);
      EXPECT_EQ(edges.edge_points[edges.part_edges[p][e]], (std::array{low, high}));
    }
}

TEST(EdgeSets, PlateAcrossTheBoxSeparatesTheFluid) {
  const auto cut = cut_mesh<2>(box_mesh(0, 0, 1, 1, 4, 4), Solids{box_mesh(-0.5, 0.6, 1.5, 0.61, 7, 1)}, {});
  const auto edges = build_edge_sets(cut);
  const auto [below, above] = sides_of(cut, edges.part_edges, 0.605);
  for (const int edge : below) EXPECT_FALSE(above.contains(edge)) << "unknown " << edge << " leaks";
  // Rows of cells 0 .. 2 and 2 .. 3: with n rows 4 (n + 1) + 5 n + 4 n edges.
  EXPECT_EQ(below.size(), 43u);
  EXPECT_EQ(above.size(), 30u);
  EXPECT_EQ(edges.edge_points.size(), 73u);
}

TEST(EdgeSets, AroundTheTipOfAPlateTheFluidIsOne) {
  const auto cut = cut_mesh<2>(box_mesh(0, 0, 1, 1, 4, 4), Solids{box_mesh(-0.5, 0.6, 0.55, 0.61, 5, 1)}, {});
  const auto edges = build_edge_sets(cut);
  std::map<std::array<int, 2>, int> count;
  for (const auto& points : edges.edge_points) ++count[points];
  for (const auto& [points, times] : count) {
    const Point<2> middle = 0.5 * (cut.mesh.points[points[0]] + cut.mesh.points[points[1]]);
    // Doubled: the edges that the plate crosses from below to above, and those that are wholly behind it.
    const bool beside = middle[1] > 0.45 && middle[1] < 0.8;
    EXPECT_EQ(times, beside && middle[0] < 0.45 ? 2 : 1) << middle.transpose();
  }
}

} // namespace
} // namespace undula::geometry
