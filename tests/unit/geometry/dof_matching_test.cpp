// The matching of unknowns from one cut to the next, against the side of the plate each of them stands on.
#include "geometry/cut/dof_matching.hpp"

#include <random>
#include <set>

#include "cut_invariants.hpp"
#include "geometry/cut/part_lookup.hpp"
#include "rom/base/error.hpp"

namespace undula::geometry {
namespace {

using namespace test;

struct Numbered {
  Numbered(const Mesh& background, const Solids& solids)
      : cut(cut_mesh<2>(background, solids, {})), dofs(build_dof_sets(cut)) {}
  CutMesh<2> cut;
  DofSets<2> dofs;
};

std::vector<int> matched(const Numbered& before, const Numbered& now) {
  return match_dofs(before.cut, before.dofs, now.cut, now.dofs);
}

Point<2> point_in(const CutMesh<2>& cut, int part) {
  if (cut.parts[part].cut) return cut.volume_quadrature.points[cut.parts[part].quadrature_begin];
  const auto& cell = cut.mesh.cells[cut.parts[part].cell];
  return (cut.mesh.points[cell[0]] + cut.mesh.points[cell[1]] + cut.mesh.points[cell[2]]) / 3;
}

/// +1 above, -1 below the plate by unknown; fails if a set has parts on both sides.
template <class Height>
std::vector<int> sides(const Numbered& numbered, const Height& height) {
  std::vector<int> side(numbered.dofs.dof_point.size(), 0);
  for (int part = 0; part < static_cast<int>(numbered.cut.parts.size()); ++part) {
    const auto x = point_in(numbered.cut, part);
    const int above = x[1] > height(x[0]) ? 1 : -1;
    for (const int dof : numbered.dofs.part_dofs[part]) {
      EXPECT_NE(side[dof], -above);
      side[dof] = above;
    }
  }
  return side;
}

void expect_one_to_one(const std::vector<int>& match) {
  std::set<int> used;
  for (const int before : match)
    if (before >= 0) {
      EXPECT_TRUE(used.insert(before).second) << before;
    }
}

TEST(DofMatching, WithoutMotionIsTheIdentity) {
  const Numbered cut(box_mesh(0, 0, 1, 1, 6, 6),
                     {moved(box_mesh(-0.3, -0.01, 0.3, 0.01, 6, 2), {0.5, 0.5}, 0.3)});
  const auto match = matched(cut, cut);
  for (std::size_t i = 0; i < match.size(); ++i) EXPECT_EQ(match[i], static_cast<int>(i));
}

// A plate thinner than an element crosses 1 to 5 elements in 200 steps, of less than its thickness each.
TEST(DofMatching, NeverCrossesAMovingPlate) {
  const double thickness = 0.02;
  for (const int crossed : {1, 2, 3, 4, 5}) {
    for (const double tilt : {0.0, 0.05}) {
      const Mesh background = box_mesh(0, 0, 1, 1, 6, 6);
      const double travel = crossed / 6.0, start = 0.06;
      const auto cut_at = [&](int step) {
        const double y = start + travel * step / 200;
        return Numbered(background, {moved(box_mesh(-1, 0, 1, thickness, 9, 2), Point<2>(0.5, y), tilt)});
      };
      const auto height_at = [&](int step) {
        return [=](double x) {
          return start + travel * step / 200 + (x - 0.5) * std::tan(tilt) + thickness / 2;
        };
      };
      auto before = cut_at(0);
      auto side_before = sides(before, height_at(0));
      int swept = 0, vanished = 0;
      for (int step = 1; step <= 200; ++step) {
        auto now = cut_at(step);
        auto side_now = sides(now, height_at(step));
        const auto match = matched(before, now);
        expect_one_to_one(match);
        std::vector<char> kept(side_before.size(), 0);
        for (std::size_t i = 0; i < match.size(); ++i) {
          if (match[i] < 0) {
            ++swept;
            continue;
          }
          kept[match[i]] = 1;
          ASSERT_EQ(now.dofs.dof_point[i], before.dofs.dof_point[match[i]]);
          ASSERT_EQ(side_now[i], side_before[match[i]]) << "step " << step << ", unknown " << i;
        }
        for (const char k : kept) vanished += !k;
        before = std::move(now);
        side_before = std::move(side_now);
      }
      // Each row of points that the plate's support enters gets new unknowns once, and loses others once.
      EXPECT_GE(swept, 7 * (crossed - 1));
      EXPECT_LE(swept, 7 * (crossed + 2));
      EXPECT_GE(vanished, 7 * (crossed - 1));
      EXPECT_LE(vanished, 7 * (crossed + 2));
    }
  }
}

TEST(DofMatching, PointsSweptByThePlateGetNewUnknowns) {
  // The points at y = 0.5 leave the plate at its upper side.
  const Mesh background = box_mesh(0, 0, 1, 1, 4, 4);
  const Numbered before(background, {box_mesh(-1, 0.485, 2, 0.51, 5, 1)});
  const Numbered now(background, {box_mesh(-1, 0.47, 2, 0.495, 5, 1)});
  const auto side_before = sides(before, [](double) { return 0.4975; });
  const auto side_now = sides(now, [](double) { return 0.4825; });
  const auto match = matched(before, now);
  int fresh = 0;
  for (std::size_t i = 0; i < match.size(); ++i) {
    if (match[i] < 0) {
      ++fresh;
      // Above the plate now, in the row below it, where no unknown above reached before.
      EXPECT_EQ(side_now[i], 1);
      EXPECT_EQ(now.cut.mesh.points[now.dofs.dof_point[i]][1], 0.25);
    } else {
      EXPECT_EQ(side_now[i], side_before[match[i]]);
    }
  }
  EXPECT_EQ(fresh, 5);
}

TEST(DofMatching, DoesNotDependOnTheOrderOfCells) {
  Mesh background = box_mesh(0, 0, 1, 1, 5, 5);
  const auto plate = [](double y) {
    return Solids{moved(box_mesh(-0.4, 0, 0.35, 0.02, 9, 2), {0.3, y}, 0.1)};
  };
  const auto pairs = [&] { // (point, side) of each matched unknown
    const Numbered before(background, plate(0.55)), now(background, plate(0.56));
    const auto match = matched(before, now);
    const auto where = [](const Numbered& n, int dof) {
      double lowest = 1e9; // the lowest point of the set: a name that does not depend on numbers
      for (int part = 0; part < static_cast<int>(n.cut.parts.size()); ++part)
        for (const int d : n.dofs.part_dofs[part])
          if (d == dof) {
            const auto& record = n.cut.parts[part];
            if (!record.cut)
              for (const int p : n.cut.mesh.cells[record.cell])
                lowest = std::min(lowest, n.cut.mesh.points[p][1]);
            for (int s = record.simplex_begin; s < record.simplex_end; ++s)
              for (const auto& v : n.cut.simplices[s]) lowest = std::min(lowest, v[1]);
          }
      const auto& x = n.cut.mesh.points[n.dofs.dof_point[dof]];
      return std::array<long, 3>{std::lround(1e6 * x[0]), std::lround(1e6 * x[1]), std::lround(1e6 * lowest)};
    };
    std::set<std::array<std::array<long, 3>, 2>> found;
    for (std::size_t i = 0; i < match.size(); ++i)
      if (match[i] >= 0) found.insert({where(now, static_cast<int>(i)), where(before, match[i])});
    return found;
  };
  const auto reference = pairs();
  EXPECT_GT(reference.size(), 36u);
  std::mt19937 random(5);
  for (int k = 0; k < 5; ++k) {
    std::shuffle(background.cells.begin(), background.cells.end(), random);
    for (auto& cell : background.cells) std::rotate(cell.begin(), cell.begin() + random() % 3, cell.end());
    EXPECT_EQ(pairs(), reference);
  }
}

TEST(DofMatching, PlateThatJumpsWithinItsElementsMatchesNothingThere) {
  // By 15 thicknesses: below now lies over above before, and both sides still exist.
  const Mesh background = box_mesh(0, 0, 1, 1, 1, 1);
  const Numbered before(background, {box_mesh(-1, 0.30, 2, 0.32, 5, 1)});
  const Numbered now(background, {box_mesh(-1, 0.60, 2, 0.62, 5, 1)});
  for (const int match : matched(before, now)) EXPECT_EQ(match, -1);
}

TEST(DofMatching, PlateThatJumpsIntoElementsLeavesTheSmallerSideNew) {
  const Mesh background = box_mesh(0, 0, 1, 1, 1, 1);
  const Numbered before(background, {});
  const Numbered now(background, {box_mesh(-1, 0.80, 2, 0.82, 5, 1)});
  const auto side = sides(now, [](double) { return 0.81; });
  const auto match = matched(before, now);
  expect_one_to_one(match);
  for (std::size_t i = 0; i < match.size(); ++i) EXPECT_EQ(match[i] >= 0, side[i] < 0) << i;
}

TEST(DofMatching, PartsThatShareNoPointAreNotMatched) {
  // A slot between two bodies: fluid at the left before, at the right now.
  const Mesh background = box_mesh(0, 0, 1, 1, 1, 1);
  const Numbered before(background, {box_mesh(0.2, -1, 3, 2, 1, 1)});
  const Numbered now(background, {box_mesh(-2, -1, 0.8, 2, 1, 1)});
  ASSERT_FALSE(before.dofs.dof_point.empty());
  ASSERT_FALSE(now.dofs.dof_point.empty());
  for (const int match : matched(before, now)) EXPECT_EQ(match, -1);
}

TEST(DofMatching, LargestOverlapWinsWhereATipHasLeft) {
  // The element is halved before and whole now: 0.3 of its height below the plate, 0.68 above.
  const Mesh background = box_mesh(0, 0, 1, 1, 1, 1);
  const Numbered before(background, {box_mesh(-1, 0.30, 2, 0.32, 5, 1)});
  const Numbered now(background, {});
  const auto side = sides(before, [](double) { return 0.31; });
  const auto match = matched(before, now);
  // Overlaps at (0, 0) and (1, 1) are those of both triangles: above is larger. At (1, 0), of the lower
  // triangle only, below takes 1/2 - 0.7^2 / 2 = 0.255 and above 0.68^2 / 2 = 0.231.
  ASSERT_EQ(match.size(), 4u);
  EXPECT_EQ(side[match[0]], 1);
  EXPECT_EQ(side[match[1]], -1);
  EXPECT_EQ(side[match[2]], 1);
  EXPECT_EQ(side[match[3]], 1);
}

TEST(DofMatching, OfDifferentMeshesIsRefused) {
  const Numbered a(box_mesh(0, 0, 1, 1, 2, 2), {}), b(box_mesh(0, 0, 1, 1, 3, 2), {});
  EXPECT_THROW(matched(a, b), InputError);
}

TEST(PartLookup, FindsThePartOfAPoint) {
  const Solids plate{box_mesh(-1, 0.3, 2, 0.31, 6, 1)};
  Mesh triangle;
  triangle.points = {{0, 0}, {1, 0}, {0, 1}};
  triangle.cells = {{0, 1, 2}};
  const auto cut = cut_mesh<2>(triangle, plate, {});
  const int below = part_at<2>(cut, 0, {0.2, 0.1}), above = part_at<2>(cut, 0, {0.2, 0.6});
  EXPECT_GE(below, 0);
  EXPECT_GE(above, 0);
  EXPECT_NE(below, above);
  EXPECT_NEAR(cut.parts[below].measure, 0.5 - 0.5 * 0.7 * 0.7, 1e-14);
  EXPECT_EQ(part_at<2>(cut, 0, {0.2, 0.305}), -1);
  // The simplices fill the part.
  for (const int part : {below, above}) {
    double sum = 0;
    for (int s = cut.parts[part].simplex_begin; s < cut.parts[part].simplex_end; ++s) {
      const auto& v = cut.simplices[s];
      sum += std::abs((v[1] - v[0])[0] * (v[2] - v[0])[1] - (v[1] - v[0])[1] * (v[2] - v[0])[0]) / 2;
    }
    EXPECT_NEAR(sum, cut.parts[part].measure, 1e-15);
  }
}

} // namespace
} // namespace undula::geometry
