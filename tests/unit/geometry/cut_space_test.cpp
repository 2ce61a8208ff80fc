// The cut in space: invariants, coincidences, thin plates, renumbering, rotation, scaling.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <numbers>
#include <random>

#include "geometry/cut/cut.hpp"
#include "geometry/cut/cut_reproducer.hpp"
#include "geometry/cut/dof_matching.hpp"
#include "geometry/mesh/space_mesh.hpp"
#include "rom/base/error.hpp"
#include "space_invariants.hpp"

namespace undula::geometry {
namespace {

using namespace test;

constexpr double tight = 1e-12;

Mesh3 box(const Point<3>& low, const Point<3>& high, const std::array<int, 3>& counts) {
  auto mesh = box_mesh({low, high}, counts);
  mesh.boundary.clear();
  return mesh;
}

Eigen::Matrix3d rotation(double angle, const Point<3>& axis) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

CutMesh<3> checked_cut(const Mesh3& background, const Solids3& solids, double tolerance = tight) {
  auto cut = cut_mesh<3>(background, solids, {});
  expect_moments(cut, solids, tolerance);
  expect_closed(cut, tolerance);
  return cut;
}

const Mesh3& unit_box() {
  static const auto mesh = box_mesh({{0, 0, 0}, {1, 1, 1}}, {4, 4, 4});
  return mesh;
}

TEST(CutSpace, WithoutSolidsIsTheMesh) {
  const auto cut = checked_cut(box_mesh({{0, 0, 0}, {2, 1, 1}}, {3, 2, 2}), {});
  const auto s = summary(cut);
  EXPECT_EQ(s.parts, 72u);
  EXPECT_EQ(s.cut_parts, 0u);
  EXPECT_EQ(s.boundary_pieces, 64u);
  EXPECT_EQ(s.connections, (72u * 4 - 64) / 2);
  EXPECT_EQ(s.unknowns, 36u);
  EXPECT_NEAR(s.volume, 2, 1e-14);
  EXPECT_NEAR(s.boundary, 10, 1e-14);
}

TEST(CutSpace, ATurnedBoxIsCutInFloatingPoint) {
  const Solids3 solids{moved(box({-0.2, -0.15, -0.1}, {0.2, 0.15, 0.1}, {2, 2, 1}), {0.52, 0.47, 0.51},
                             rotation(0.4, {1, 2, 3}))};
  const auto cut = checked_cut(unit_box(), solids);
  const auto s = summary(cut);
  EXPECT_EQ(cut.exact_cells, 0);
  EXPECT_GT(cut.filtered_cells, 40);
  EXPECT_NEAR(s.volume, 1 - 0.4 * 0.3 * 0.2, tight);
  EXPECT_NEAR(s.interface, 2 * (0.4 * 0.3 + 0.4 * 0.2 + 0.3 * 0.2), tight);
  EXPECT_NEAR(s.boundary, 6, tight);
}

// A plate through positions on binary fractions: points, edges and facets of plate and grid coincide exactly.
void sweep(int positions) {
  const Mesh3 plate = box({0, 0, 0}, {0.5, 0.375, 0.0625}, {2, 3, 1});
  int filtered = 0, exact = 0;
  for (int step = 0; step < positions; ++step) {
    SCOPED_TRACE("position " + std::to_string(step) + " of " + std::to_string(positions));
    const double s = std::round(1024.0 * step / positions) / 1024;
    const Solids3 solids{moved(plate, Point<3>(0.5 * s, 0.125 + 0.25 * s, 0.0625 + 0.75 * s))};
    const auto cut = checked_cut(unit_box(), solids);
    filtered += cut.filtered_cells;
    exact += cut.exact_cells;
    const double on_wall = solids[0].points[0][0] == 0 ? 0.375 * 0.0625 : 0; // starts flush with it
    const auto total = summary(cut);
    ASSERT_NEAR(total.volume, 1 - 0.5 * 0.375 * 0.0625, tight);
    ASSERT_NEAR(total.interface, 2 * (0.5 * 0.375 + 0.5 * 0.0625 + 0.375 * 0.0625) - on_wall, tight);
    ASSERT_NEAR(total.boundary, 6 - on_wall, tight);
    if (testing::Test::HasFailure()) return;
  }
  std::printf("%d positions: %d cells cut in floating point, %d in exact arithmetic\n", positions, filtered,
              exact);
}

TEST(CutSpace, SweepOfAPlate) { sweep(16); }
TEST(CutSpace, DISABLED_SweepOfAPlateThroughAThousandPositions) { sweep(1000); }

/// Whether each of `count` unknowns, given by part, is one of parts below (0) and above (1) a plane.
template <class ByPart>
std::array<std::vector<char>, 2> sides_of(const CutMesh<3>& cut, const ByPart& unknowns, std::size_t count,
                                          const Point<3>& normal, const Point<3>& on_it) {
  std::array<std::vector<char>, 2> seen;
  for (auto& side : seen) side.assign(count, 0);
  for (std::size_t p = 0; p < cut.parts.size(); ++p) {
    const auto& part = cut.parts[p];
    Point<3> x = Point<3>::Zero();
    if (part.cut)
      x = cut.volume_quadrature.points[part.quadrature_begin];
    else
      for (const int v : cut.mesh.cells[part.cell]) x += cut.mesh.points[v] / 4;
    for (const int unknown : unknowns[p]) seen[(x - on_it).dot(normal) > 0][unknown] = 1;
  }
  return seen;
}

TEST(CutSpace, UnknownsKeepTheirSideWhileAPlateMoves) {
  const Mesh3 plate = box({-1, -1, -0.01}, {1, 1, 0.01}, {3, 3, 1});
  const auto turn = rotation(0.2, {1, 2, 0});
  const Point<3> normal = turn * Point<3>(0, 0, 1);
  const BackgroundCutter<3> cutter(unit_box(), Solids3{plate}, {});
  const auto place = [&](int step) -> Point<3> { return Point<3>(0.5, 0.5, 0.42) + 0.012 * step * normal; };
  auto before = cutter.cut(Solids3{moved(plate, place(0), turn)});
  auto dofs_before = build_dof_sets(before);
  int fresh = 0;
  for (int step = 1; step < 12; ++step) {
    SCOPED_TRACE(step);
    auto now = cutter.cut(Solids3{moved(plate, place(step), turn)});
    auto dofs_now = build_dof_sets(now);
    const auto match = match_dofs(before, dofs_before, now, dofs_now);
    const auto old_sides =
        sides_of(before, dofs_before.part_dofs, dofs_before.dof_point.size(), normal, place(step - 1));
    const auto new_sides = sides_of(now, dofs_now.part_dofs, dofs_now.dof_point.size(), normal, place(step));
    std::vector<char> taken(dofs_before.dof_point.size(), 0);
    for (std::size_t d = 0; d < match.size(); ++d) {
      if (match[d] < 0) {
        ++fresh;
        continue;
      }
      EXPECT_FALSE(taken[match[d]]);
      taken[match[d]] = 1;
      EXPECT_EQ(dofs_now.dof_point[d], dofs_before.dof_point[match[d]]);
      for (int side : {0, 1}) EXPECT_EQ(new_sides[side][d], old_sides[side][match[d]]);
    }
    before = std::move(now);
    dofs_before = std::move(dofs_now);
  }
  EXPECT_GT(fresh, 20); // the plate has swept over points
  EXPECT_LT(fresh, 11 * 60);
}

TEST(CutSpace, ThinPlatesPartTheFluid) {
  for (const double thickness : {1e-3, 1e-9, 1e-13})
    for (const double angle : {0.0, 0.3}) {
      SCOPED_TRACE(std::to_string(thickness) + " thick, turned by " + std::to_string(angle));
      // Wider than the box, so that nothing goes round it.
      const Solids3 solids{moved(box({-1, -1, -thickness / 2}, {1, 1, thickness / 2}, {3, 2, 1}),
                                 {0.5, 0.5, 0.55}, rotation(angle, {1, 2, 0}))};
      const auto cut = checked_cut(unit_box(), solids);
      int divided = 0;
      for (std::size_t c = 0; c < cut.mesh.cells.size(); ++c)
        divided += cut.cell_parts[c + 1] - cut.cell_parts[c] == 2;
      EXPECT_GT(divided, 60);
      // No unknown on both sides.
      const auto dofs = build_dof_sets(cut);
      const auto edges = build_edge_sets(cut);
      const Point<3> normal = rotation(angle, {1, 2, 0}) * Point<3>(0, 0, 1), on_it(0.5, 0.5, 0.55);
      const auto seen = sides_of(cut, dofs.part_dofs, dofs.dof_point.size(), normal, on_it);
      const auto edge_seen = sides_of(cut, edges.part_edges, edges.edge_points.size(), normal, on_it);
      for (std::size_t d = 0; d < dofs.dof_point.size(); ++d) EXPECT_EQ(seen[0][d] + seen[1][d], 1);
      for (std::size_t d = 0; d < edges.edge_points.size(); ++d)
        EXPECT_EQ(edge_seen[0][d] + edge_seen[1][d], 1);
    }
}

TEST(CutSpace, APlateThatEndsInAnElementLeavesItConnected) {
  const Solids3 solids{
      moved(box({-1, -1, -0.005}, {0.03, 1, 0.005}, {3, 3, 1}), {0.5, 0.5, 0.55}, rotation(0.2, {1, 2, 1}))};
  const auto cut = checked_cut(unit_box(), solids);
  EXPECT_EQ(cut.exact_cells, 0);
  int divided = 0, cut_whole = 0;
  for (std::size_t c = 0; c < cut.mesh.cells.size(); ++c) {
    const int parts = cut.cell_parts[c + 1] - cut.cell_parts[c];
    divided += parts == 2;
    cut_whole += parts == 1 && cut.parts[cut.cell_parts[c]].cut;
  }
  EXPECT_GT(divided, 30);
  EXPECT_GT(cut_whole, 10);
}

TEST(CutSpace, ABoxNearlyOnTheGridPlanes) {
  for (int exponent = 3; exponent <= 16; ++exponent) {
    const double off = std::pow(10.0, -exponent);
    SCOPED_TRACE(off);
    const Solids3 solids{
        box({0.25 + off, 0.25 - off, 0.25 + off}, {0.75 + off, 0.75 - off, 0.5 + off}, {2, 2, 1})};
    const auto cut = checked_cut(unit_box(), solids);
    const auto total = summary(cut);
    EXPECT_NEAR(total.volume, 1 - 0.0625, 4 * off * (exponent > 12 ? 1 : 0) + tight);
    EXPECT_NEAR(total.interface, 1, 8 * off * (exponent > 12 ? 1 : 0) + tight);
  }
}

TEST(CutSpace, SolidFlushWithTheWallFromOutsideIsInterface) {
  const auto cut = checked_cut(unit_box(), {box({-0.5, 0.3, 0.25}, {0, 0.6, 0.75}, {1, 1, 1})});
  const auto total = summary(cut);
  EXPECT_EQ(total.cut_parts, 0u);
  EXPECT_NEAR(total.interface, 0.15, tight);
  EXPECT_NEAR(total.boundary, 6 - 0.15, tight);
}

TEST(CutSpace, BoundaryPiecesKeepTagsAndTheWetArea) {
  const Solids3 solids{moved(box({-1, -0.2, -0.1}, {0.3, 0.2, 0.1}, {3, 1, 1}), {0.4, 0.5, 0.52})};
  const auto cut = checked_cut(unit_box(), solids);
  double area[6] = {};
  for (const auto& piece : cut.boundary) {
    EXPECT_EQ(cut.facets.facets[piece.facet].boundary_tag, piece.tag);
    for (int q = piece.quadrature_begin; q < piece.quadrature_end; ++q)
      area[piece.tag] += cut.boundary_quadrature.weights[q];
  }
  EXPECT_NEAR(area[0], 1 - 0.4 * 0.2, tight);
  for (int tag = 1; tag < 6; ++tag) EXPECT_NEAR(area[tag], 1, tight);
}

TEST(CutSpace, InterfacePiecesPointIntoTheirSolidCell) {
  const Solids3 solids{
      moved(box({-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}, {2, 2, 2}), {0.4, 0.5, 0.52}, rotation(0.5, {3, 1, 2})),
      moved(box({-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05}, {1, 1, 1}), {0.86, 0.8, 0.8},
            rotation(1, {0, 1, 2}))};
  const auto cut = checked_cut(unit_box(), solids);
  ASSERT_FALSE(cut.interface.empty());
  for (const auto& piece : cut.interface) {
    ASSERT_LT(piece.quadrature_begin, piece.quadrature_end);
    for (int q = piece.quadrature_begin; q < piece.quadrature_end; ++q) {
      const Point<3> x = cut.interface_quadrature.points[q];
      const auto& solid = solids[piece.solid];
      const auto lambda = barycentric_coordinates(solid, piece.solid_cell, x);
      const auto gradients = barycentric_gradients(solid, piece.solid_cell);
      EXPECT_NEAR(lambda.minCoeff(), 0, 1e-12);
      bool on_a_facet = false; // from which the normal points inwards
      for (int i = 0; i < 4; ++i)
        on_a_facet = on_a_facet || (std::abs(lambda[i]) < 1e-12 &&
                                    (gradients.col(i).normalized() - piece.normal).norm() < 1e-9);
      EXPECT_TRUE(on_a_facet);
      EXPECT_GT(barycentric_coordinates(cut.mesh, cut.parts[piece.part].cell, x).minCoeff(), -1e-12);
    }
  }
}

TEST(CutSpace, TwoSolidsInContactLeaveNoFluidBetween) {
  const Mesh3 left = box({0.2, 0.3, 0.3}, {0.45, 0.7, 0.7}, {1, 2, 2});
  const Mesh3 right = box({0.45, 0.4, 0.4}, {0.8, 0.8, 0.8}, {2, 1, 1}); // meshes do not match at x = 0.45
  const auto cut = checked_cut(unit_box(), {left, right});
  const double surfaces = 2 * (0.4 * 0.4 + 2 * 0.25 * 0.4) + 2 * (0.4 * 0.4 + 2 * 0.35 * 0.4);
  EXPECT_NEAR(summary(cut).interface, surfaces - 2 * 0.3 * 0.3, tight);
}

TEST(CutSpace, BackgroundInsideTheSolidHasNoFluid) {
  const auto cut =
      checked_cut(box_mesh({{0, 0, 0}, {1, 1, 1}}, {2, 2, 2}), {box({-1, -1, -1}, {2, 2, 2}, {2, 2, 2})});
  EXPECT_TRUE(cut.parts.empty());
  EXPECT_TRUE(cut.interface.empty());
  EXPECT_TRUE(cut.boundary.empty());
}

TEST(CutSpace, ABodyInsideOfOneElement) {
  const Solids3 solids{moved(box({-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}, {1, 1, 1}), {0.14, 0.09, 0.05},
                             rotation(0.3, {1, 1, 0}))};
  const auto cut = checked_cut(unit_box(), solids);
  EXPECT_EQ(cut.exact_cells, 1); // a surface closed in a cell
  EXPECT_NEAR(summary(cut).interface, 6 * 0.0004, tight);
}

// Hollow: the skin has two surfaces, and the fluid inside is closed off.
TEST(CutSpace, AHollowBody) {
  Mesh3 body = box({-0.3, -0.3, -0.3}, {0.3, 0.3, 0.3}, {3, 3, 3});
  std::erase_if(body.cells, [&](const auto& cell) {
    Point<3> middle = Point<3>::Zero();
    for (const int p : cell) middle += body.points[p] / 4;
    return middle.cwiseAbs().maxCoeff() < 0.1;
  });
  ASSERT_EQ(body.cells.size(), 26u * 6);
  const auto cut = checked_cut(unit_box(), {moved(body, {0.51, 0.52, 0.49}, rotation(0.7, {1, 3, 2}))});
  EXPECT_NEAR(summary(cut).volume, 1 - 0.216 + 0.008, tight);
  EXPECT_NEAR(summary(cut).interface, 6 * (0.36 + 0.04), tight);
}

TEST(CutSpace, ASectorOfABodyOfRevolutionWithADiscInIt) {
  TaggedPolygon chamber, disc;
  chamber.points = {{0.3, 0}, {1, 0}, {1, 0.4}, {0.3, 0.3}};
  chamber.tags = {0, 1, 2, 3};
  chamber.names = {"lower", "rim", "upper", "inlet"};
  disc.points = {{0.45, 0.15}, {1.2, 0.15}, {1.2, 0.19}, {0.45, 0.19}};
  disc.tags = {0, 0, 0, 0};
  disc.names = {"skin"};
  const auto background = mesh_revolved(chamber, 40, [](const Point<3>&) { return 0.1; });
  const auto ring = mesh_revolved(disc, 60, [](const Point<3>&) { return 0.06; });
  auto bent = moved(ring, Point<3>::Zero(), rotation(-0.17, {0, 0, 1})); // reaches beyond the sector
  bent.boundary.clear();
  for (auto& p : bent.points) p[2] += 0.05 * std::sin(7 * std::hypot(p[0], p[1]) + 3 * p[1]);
  const auto cut = checked_cut(background, {bent});
  EXPECT_EQ(cut.exact_cells, 0);
  EXPECT_GT(cut.filtered_cells, 400);
  std::printf("%zu cells, %d cut\n", background.cells.size(), cut.filtered_cells);
}

TEST(CutSpace, IsInvariantUnderRenumbering) {
  Mesh3 background = unit_box();
  Solids3 solids{moved(box({-0.3, -0.2, -0.03}, {0.3, 0.2, 0.03}, {3, 2, 1}), {0.52, 0.47, 0.51},
                       rotation(0.4, {1, 2, 3}))};
  const auto before = summary(checked_cut(background, solids));
  std::mt19937 random(3);
  for (int k = 0; k < 5; ++k) {
    renumber(background, random);
    renumber(solids[0], random);
    expect_same_numbers(summary(checked_cut(background, solids)), before, tight);
  }
}

TEST(CutSpace, IsInvariantUnderRotationAndScaling) {
  const Mesh3 body = moved(box({-0.3, -0.2, -0.03}, {0.3, 0.2, 0.03}, {3, 2, 1}), {0.52, 0.47, 0.51},
                           rotation(0.4, {1, 2, 3}));
  const auto before = summary(checked_cut(unit_box(), {body}));
  for (const double scale : {1.0, 1e-3, 1e3})
    for (const double angle : {0.0, 0.3, 1.0, std::numbers::pi}) {
      SCOPED_TRACE(std::to_string(scale) + " " + std::to_string(angle));
      const auto place = [&](const Mesh3& mesh) {
        return moved(mesh, Point<3>::Zero(), rotation(angle, {1, -2, 2}), scale);
      };
      const auto after = summary(checked_cut(place(unit_box()), {place(body)}));
      EXPECT_EQ(after.parts, before.parts);
      EXPECT_EQ(after.cut_parts, before.cut_parts);
      EXPECT_EQ(after.connections, before.connections);
      EXPECT_EQ(after.boundary_pieces, before.boundary_pieces);
      EXPECT_EQ(after.unknowns, before.unknowns);
      EXPECT_NEAR(after.volume / std::pow(scale, 3), before.volume, tight);
      EXPECT_NEAR(after.interface / std::pow(scale, 2), before.interface, tight);
      EXPECT_NEAR(after.boundary / std::pow(scale, 2), before.boundary, tight);
    }
}

TEST(CutSpace, OverlappingSolidsAreRefusedWithAReproducer) {
  const auto directory = std::filesystem::temp_directory_path() / "undula_cut_space_test";
  std::filesystem::create_directories(directory);
  CutOptions options;
  options.reproducer_directory = directory.string();
  const auto body = [](const Point<3>& at, double size, double angle) {
    return moved(box({-size, -size, -size}, {size, size, size}, {1, 1, 1}), at, rotation(angle, {1, 2, 3}));
  };
  for (const auto& second :
       {body({0.5, 0.5, 0.5}, 0.2, 0.3), body({0.65, 0.6, 0.5}, 0.1, 0.9), body({0.5, 0.52, 0.49}, 0.1, 0.9),
        body({0.55, 0.52, 0.49}, 0.02, 0.9), body({0.7, 0.5, 0.5}, 0.01, 0.1)}) {
    std::string message;
    try {
      cut_mesh<3>(unit_box(), Solids3{body({0.5, 0.5, 0.5}, 0.2, 0.3), second}, options);
    } catch (const NumericsError& error) {
      message = error.what();
    }
    const auto begin = message.find(directory.string());
    ASSERT_NE(begin, std::string::npos) << message;
    const std::string path = message.substr(begin, message.find('\n', begin) - begin);
    EXPECT_THROW(rerun_reproducer<3>(path), NumericsError);
  }
  std::filesystem::remove_all(directory);
}

TEST(CutSpace, SolidsAtNoPlaceOrTurnedInsideOutAreRefused) {
  const Solids3 body{moved(box({0, 0, 0}, {0.4, 0.1, 0.2}, {2, 1, 1}), {0.31, 0.42, 0.2})};
  const BackgroundCutter<3> cutter(unit_box(), body, {});
  ASSERT_NO_THROW(cutter.cut(body));
  auto solids = body;
  solids[0].points[5][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(cutter.cut(solids), NumericsError);
  solids = body;
  solids[0].points[0] = solids[0].points[1]; // flat
  EXPECT_THROW(cutter.cut(solids), NumericsError);
  solids = body;
  std::swap(solids[0].points[0], solids[0].points[1]);
  EXPECT_THROW(cutter.cut(solids), NumericsError);
  solids = body;
  solids[0].cells.pop_back();
  EXPECT_THROW(cutter.cut(solids), InputError);
  Mesh3 folded;
  folded.points = {{0.2, 0.2, 0.2}, {0.6, 0.2, 0.2}, {0.2, 0.6, 0.2}, {0.2, 0.2, 0.6}, {0.3, 0.3, 0.5}};
  folded.cells = {{0, 1, 2, 3}, {0, 1, 2, 4}};
  EXPECT_THROW(cut_mesh<3>(unit_box(), Solids3{folded}, {}), NumericsError);
  Mesh3 inverted = unit_box();
  std::swap(inverted.cells[7][0], inverted.cells[7][1]);
  EXPECT_THROW(cut_mesh<3>(inverted, body, {}), NumericsError);
}

TEST(CutSpace, RepeatedCutsOfOneBackgroundEqualFreshOnes) {
  const Mesh3 body = box({-0.3, -0.3, -0.02}, {0.3, 0.3, 0.02}, {3, 3, 1});
  const BackgroundCutter<3> cutter(unit_box(), Solids3{body}, {});
  for (int step = 0; step < 10; ++step) {
    const Solids3 placed{moved(body, {0.4 + 0.01 * step, 0.5, 0.52}, rotation(0.1 * step, {1, 1, 0}))};
    const auto again = cutter.cut(placed), fresh = cut_mesh<3>(unit_box(), placed, {});
    ASSERT_EQ(again.volume_quadrature.weights, fresh.volume_quadrature.weights);
    ASSERT_EQ(again.interface_quadrature.weights, fresh.interface_quadrature.weights);
    ASSERT_EQ(again.connections.size(), fresh.connections.size());
  }
}

} // namespace
} // namespace undula::geometry
