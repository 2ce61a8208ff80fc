#include "geometry/cut/cut.hpp"

#include <Eigen/Geometry>
#include <filesystem>
#include <fstream>
#include <random>

#include "cut_invariants.hpp"
#include "geometry/cut/cut_reproducer.hpp"
#include "rom/base/error.hpp"

namespace undula::geometry {
namespace {

using namespace test;

constexpr double tight = 1e-12;

CutMesh<2> checked_cut(const Mesh& background, const Solids& solids, double tolerance = tight) {
  auto cut = cut_mesh<2>(background, solids, {});
  expect_moments(cut, solids, tolerance);
  expect_closed(cut, tolerance);
  return cut;
}

TEST(Cut, WithoutSolidsIsTheMesh) {
  const auto cut = checked_cut(box_mesh(0, 0, 2, 1, 4, 3), {});
  const auto s = summary(cut);
  EXPECT_EQ(s.parts, 24u);
  EXPECT_EQ(s.cut_parts, 0u);
  EXPECT_EQ(s.connections, 2u * 24 / 2 + 12 - 7); // interior facets: (3 * 24 - 14) / 2
  EXPECT_EQ(s.boundary_pieces, 14u);
  EXPECT_EQ(s.unknowns, 20u);
  EXPECT_NEAR(s.volume, 2, 1e-14);
  EXPECT_NEAR(s.boundary, 6, 1e-14);
}

TEST(Cut, SweepOfABodyThroughTheGrid) {
  const Mesh background = box_mesh(0, 0, 1, 1, 8, 8);
  const Mesh body = box_mesh(0, 0, 0.25, 0.125, 2, 1);
  for (int step = 0; step < 1000; ++step) {
    // Binary fractions: vertices, edges and facets of body and grid coincide exactly, not up to rounding.
    const double s = step / 1024.0;
    const Solids solids{moved(body, Point<2>(0.75 * s, 0.0625 + 0.75 * s))};
    SCOPED_TRACE("step " + std::to_string(step));
    const auto cut = checked_cut(background, solids);
    const auto total = summary(cut);
    const double on_wall = step == 0 ? 0.125 : 0; // starts flush with the left wall
    ASSERT_NEAR(total.interface, 0.75 - on_wall, tight);
    ASSERT_NEAR(total.boundary, 4 - on_wall, tight);
    ASSERT_NEAR(total.volume, 1 - 0.25 * 0.125, tight);
    if (HasFatalFailure()) return;
  }
}

TEST(Cut, SweepAlongDiagonalsAndEdges) {
  // The body is two cells of the grid itself: at whole steps every one of its edges lies on edges of the
  // grid.
  const Mesh background = box_mesh(0, 0, 1, 1, 8, 8);
  Mesh body;
  body.points = {{0, 0}, {0.125, 0.125}, {0, 0.125}, {-0.125, 0}};
  body.cells = {{0, 1, 2}, {0, 2, 3}};
  const double skin = (2 + 2 * std::numbers::sqrt2) / 8;
  for (const Point<2>& direction : {Point<2>(1, 1), Point<2>(1, 0), Point<2>(0, 1)}) {
    for (int step = 0; step <= 32; ++step) {
      SCOPED_TRACE(step);
      const Solids solids{moved(body, Point<2>(0.25, 0.125) + step / 64.0 * direction)};
      const auto cut = checked_cut(background, solids);
      const auto total = summary(cut);
      ASSERT_NEAR(total.interface, skin, tight);
      if (step % 8 == 0) {
        // Nothing is cut, two elements are gone, and the skin belongs to their six neighbours across edges.
        EXPECT_EQ(total.cut_parts, 0u);
        EXPECT_EQ(total.parts, 126u);
        EXPECT_EQ(cut.interface.size(), 4u);
        EXPECT_EQ(total.unknowns, 81u);
      }
    }
  }
}

TEST(Cut, RandomBodies) {
  const Mesh background = moved(box_mesh(-1, -1, 1, 1, 6, 6), Point<2>(0, 0), 0.1);
  const Mesh body = box_mesh(-0.4, -0.15, 0.4, 0.15, 5, 2);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 200; ++trial) {
    SCOPED_TRACE(trial);
    const Point<2> shift(0.3 * uniform(random), 0.3 * uniform(random));
    const double scale = 0.02 + std::abs(uniform(random));
    const Solids solids{moved(body, shift, 3 * uniform(random), scale)};
    const auto total = summary(checked_cut(background, solids));
    ASSERT_NEAR(total.interface, 2.2 * scale, tight);
    ASSERT_NEAR(total.volume, 4 - 0.24 * scale * scale, 4 * tight);
    if (HasFatalFailure()) return;
  }
}

TEST(Cut, RandomLatticePositionsMeetExactly) {
  // Coordinates on a coarse lattice shared by grid and body: coincidences of every kind, in every trial.
  const Mesh background = box_mesh(-2, -2, 2, 2, 4, 4);
  std::mt19937 random(11);
  const auto lattice = [&random](int range) {
    return static_cast<double>(static_cast<int>(random() % (2 * range + 1)) - range);
  };
  int in_contact = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    SCOPED_TRACE(trial);
    Solids solids;
    for (int s = 0; s < 2; ++s) {
      Mesh triangle;
      for (int v = 0; v < 3; ++v) triangle.points.emplace_back(lattice(3) / 2, lattice(3) / 2);
      triangle.cells = {{0, 1, 2}};
      if (cell_measure(triangle, 0) == 0) continue;
      if (cell_measure(triangle, 0) < 0) std::swap(triangle.points[1], triangle.points[2]);
      if (s == 1 && !solids.empty()) {
        const auto overlap = clipped(cell_polygon(solids[0], 0), cell_polygon(triangle, 0));
        if (!overlap.empty() && moment(overlap, 0, 0) > 0) continue;
        in_contact += !overlap.empty();
      }
      solids.push_back(triangle);
    }
    checked_cut(background, solids);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(in_contact, 50);
}

TEST(Cut, InterfaceIsTheSkinInsideTheBox) {
  const Mesh background = box_mesh(0, 0, 1, 1, 7, 9);
  const Mesh body = box_mesh(-0.6, -0.1, 0.6, 0.1, 9, 2);
  for (int k = 0; k < 50; ++k) {
    const Solids solids{moved(body, Point<2>(0.1 + 0.018 * k, 0.4), 0.37 * k)};
    const auto cut = checked_cut(background, solids);
    EXPECT_NEAR(summary(cut).interface, skin_in_box(solids, 0, 0, 1, 1), 1e-12) << k;
  }
}

TEST(Cut, InterfacePiecesPointIntoTheirSolidCell) {
  const Solids solids{moved(box_mesh(0, 0, 0.3, 0.3, 3, 3), Point<2>(0.21, 0.17), 0.2),
                      moved(box_mesh(0, 0, 0.2, 0.2, 2, 2), Point<2>(0.61, 0.55), 0.5)};
  const auto cut = checked_cut(box_mesh(0, 0, 1, 1, 8, 8), solids);
  ASSERT_FALSE(cut.interface.empty());
  for (const auto& piece : cut.interface) {
    EXPECT_NEAR(piece.normal.norm(), 1, 1e-14);
    ASSERT_LT(piece.quadrature_begin, piece.quadrature_end);
    for (int q = piece.quadrature_begin; q < piece.quadrature_end; ++q) {
      const Point<2> x = cut.interface_quadrature.points[q];
      const auto& solid = solids[piece.solid];
      EXPECT_NEAR(barycentric_coordinates(solid, piece.solid_cell, x).minCoeff(), 0, 1e-12);
      EXPECT_GT(barycentric_coordinates<2>(solid, piece.solid_cell, x + 1e-6 * piece.normal).minCoeff(), 0);
      EXPECT_GT(barycentric_coordinates(cut.mesh, cut.parts[piece.part].cell, x).minCoeff(), -1e-12);
    }
  }
}

TEST(Cut, RuleDegreesAreThoseAskedFor) {
  const Mesh background = box_mesh(0, 0, 1, 1, 1, 1);
  const Solids solids{moved(box_mesh(0, 0, 0.3, 0.3, 1, 1), Point<2>(0.31, 0.27), 0.3)};
  CutOptions options;
  options.volume_degree = 6;
  options.interface_degree = 7;
  const auto cut = cut_mesh<2>(background, solids, options);
  double volume = 0;
  for (std::size_t q = 0; q < cut.volume_quadrature.weights.size(); ++q)
    volume += cut.volume_quadrature.weights[q] * std::pow(cut.volume_quadrature.points[q][0], 6);
  long double expected = 1.0L / 7;
  for (int c : {0, 1}) expected -= moment(cell_polygon(solids[0], c), 6, 0);
  EXPECT_NEAR(volume, static_cast<double>(expected), 1e-14);
  // Divergence theorem over the skin, normals into the solid: int x^7 n_x = -7 int x^6.
  double flux = 0;
  for (const auto& piece : cut.interface)
    for (int q = piece.quadrature_begin; q < piece.quadrature_end; ++q)
      flux += cut.interface_quadrature.weights[q] * std::pow(cut.interface_quadrature.points[q][0], 7) *
              piece.normal[0];
  EXPECT_NEAR(flux, -7 * static_cast<double>(1.0L / 7 - expected), 1e-14);
}

TEST(Cut, TwoSolidsInContactLeaveNoFluidBetween) {
  const Mesh left = box_mesh(0.2, 0.3, 0.45, 0.7, 2, 3);
  const Mesh right = box_mesh(0.45, 0.4, 0.8, 0.8, 3, 2); // meshes do not match along x = 0.45
  const auto cut = checked_cut(box_mesh(0, 0, 1, 1, 7, 7), {left, right});
  EXPECT_NEAR(summary(cut).interface, 2 * (0.25 + 0.4) + 2 * (0.35 + 0.4) - 2 * 0.3, tight);
  for (const auto& piece : cut.interface)
    for (int q = piece.quadrature_begin; q < piece.quadrature_end; ++q) {
      const auto& x = cut.interface_quadrature.points[q];
      EXPECT_FALSE(std::abs(x[0] - 0.45) < 1e-9 && x[1] > 0.4 && x[1] < 0.7);
    }
}

TEST(Cut, SolidFlushWithTheWallFromOutsideIsInterface) {
  const auto cut = checked_cut(box_mesh(0, 0, 1, 1, 4, 4), {box_mesh(-0.5, 0.3, 0, 0.6, 1, 1)});
  const auto total = summary(cut);
  EXPECT_EQ(total.cut_parts, 0u);
  EXPECT_NEAR(total.interface, 0.3, tight);
  EXPECT_NEAR(total.boundary, 4 - 0.3, tight);
}

TEST(Cut, BoundaryPiecesKeepTagsAndTheWetLength) {
  const auto cut = checked_cut(box_mesh(0, 0, 1, 1, 4, 4), {box_mesh(-0.5, 0.3, 0.7, 0.6, 3, 1)});
  double length[4] = {};
  for (const auto& piece : cut.boundary) {
    EXPECT_EQ(cut.facets.facets[piece.facet].boundary_tag, piece.tag);
    for (int q = piece.quadrature_begin; q < piece.quadrature_end; ++q)
      length[piece.tag] += cut.boundary_quadrature.weights[q];
  }
  EXPECT_NEAR(length[0], 0.7, tight);
  for (int tag : {1, 2, 3}) EXPECT_NEAR(length[tag], 1, tight);
}

TEST(Cut, BackgroundInsideTheSolidHasNoFluid) {
  const auto cut = checked_cut(box_mesh(0, 0, 1, 1, 2, 2), {box_mesh(-1, -1, 2, 2, 3, 4)});
  EXPECT_TRUE(cut.parts.empty());
  EXPECT_TRUE(cut.connections.empty());
  EXPECT_TRUE(cut.interface.empty());
  EXPECT_TRUE(cut.boundary.empty());
}

TEST(Cut, SliversKeepTheInvariants) {
  const Mesh background = box_mesh(0, 0, 1, 1, 4, 4);
  for (int exponent = 1; exponent <= 16; ++exponent) {
    const double offset = std::pow(10.0, -exponent);
    const Solids solids{box_mesh(0.25 + offset, 0.25 - offset, 0.75 + offset, 0.5 + offset, 3, 2)};
    const auto cut = checked_cut(background, solids);
    EXPECT_NEAR(summary(cut).interface, 1.5 + 4 * offset, tight);
  }
}

TEST(Cut, IsInvariantUnderRenumbering) {
  Mesh background = box_mesh(0, 0, 1, 1, 6, 5);
  Solids solids{moved(box_mesh(0, 0, 0.5, 0.2, 4, 2), Point<2>(0.3, 0.3), 0.4)};
  const auto before = summary(checked_cut(background, solids));
  std::mt19937 random(3);
  for (int k = 0; k < 10; ++k) {
    renumber(background, random);
    renumber(solids[0], random);
    expect_same_numbers(summary(checked_cut(background, solids)), before, tight);
  }
}

TEST(Cut, IsInvariantUnderRotationAndScaling) {
  const Mesh background = box_mesh(0, 0, 1, 1, 6, 5);
  const Mesh body = moved(box_mesh(0, 0, 0.5, 0.2, 4, 2), Point<2>(0.3, 0.3), 0.4);
  const auto before = summary(checked_cut(background, {body}));
  for (const double scale : {1.0, 1e-3, 1e3}) {
    for (const double angle : {0.0, 0.3, 1.0, 2.0, std::numbers::pi}) {
      const auto place = [&](const Mesh& mesh) { return moved(mesh, Point<2>(0, 0), angle, scale); };
      const auto after = summary(checked_cut(place(background), {place(body)}));
      EXPECT_EQ(after.parts, before.parts);
      EXPECT_EQ(after.cut_parts, before.cut_parts);
      EXPECT_EQ(after.connections, before.connections);
      EXPECT_EQ(after.boundary_pieces, before.boundary_pieces);
      EXPECT_EQ(after.unknowns, before.unknowns);
      EXPECT_NEAR(after.volume, before.volume * scale * scale, tight * scale * scale);
      EXPECT_NEAR(after.interface, before.interface * scale, tight * scale);
      EXPECT_NEAR(after.boundary, before.boundary * scale, tight * scale);
    }
  }
}

TEST(Cut, OverlappingSolidsLeaveAReproducerThatFailsAgain) {
  const auto directory = std::filesystem::temp_directory_path() / "undula_cut_test";
  std::filesystem::create_directories(directory);
  CutOptions options;
  options.reproducer_directory = directory.string();
  const Mesh body = moved(box_mesh(0, 0, 0.3, 0.3, 2, 2), Point<2>(0.31, 0.27), 0.3);
  std::string message;
  try {
    cut_mesh<2>(box_mesh(0, 0, 1, 1, 4, 4), Solids{body, body}, options);
  } catch (const NumericsError& error) {
    message = error.what();
  }
  const auto begin = message.find(directory.string());
  ASSERT_NE(begin, std::string::npos) << message;
  const std::string path = message.substr(begin, message.find('\n', begin) - begin);
  EXPECT_EQ(read_reproducer<2>(path).background.cells.size(), 1u);
  EXPECT_THROW(rerun_reproducer<2>(path), NumericsError);
  std::filesystem::remove_all(directory);
}

TEST(Cut, ReproducerGivesTheSameCutBitForBit) {
  const auto path = (std::filesystem::temp_directory_path() / "undula_cut_reproducer.txt").string();
  const Mesh background = box_mesh(0, 0, 1, 1, 4, 4);
  const Solids solids{moved(box_mesh(0, 0, 0.3, 0.3, 2, 2), Point<2>(0.31, 0.27), 0.3),
                      moved(box_mesh(0, 0, 0.1, 0.1, 1, 1), Point<2>(0.1, 0.9), 0.7)};
  const auto cut = cut_mesh<2>(background, solids, {});
  std::vector<SolidCell> all;
  for (int s : {0, 1})
    for (int c = 0; c < static_cast<int>(solids[s].cells.size()); ++c) all.push_back({s, c});
  int compared = 0;
  for (const auto& part : cut.parts) {
    if (!part.cut || cut.cell_parts[part.cell + 1] - cut.cell_parts[part.cell] != 1) continue;
    write_reproducer(make_reproducer<2>(background, part.cell, solids, all, {}), path);
    const auto again = rerun_reproducer<2>(path);
    ASSERT_EQ(again.parts.size(), 1u);
    EXPECT_EQ(again.parts[0].measure, part.measure);
    for (int q = 0; q < again.parts[0].quadrature_end; ++q)
      EXPECT_EQ(again.volume_quadrature.points[q], cut.volume_quadrature.points[part.quadrature_begin + q]);
    ++compared;
  }
  EXPECT_GT(compared, 4);
  std::filesystem::remove(path);
}

TEST(Cut, ForeignFileIsNoReproducer) {
  const auto path = (std::filesystem::temp_directory_path() / "undula_cut_foreign.txt").string();
  std::ofstream(path) << "undula-cut-reproducer 1\ndimension 2\ndegrees 3 5 x\n";
  EXPECT_THROW(read_reproducer<2>(path), InputError);
  EXPECT_THROW(read_reproducer<3>(path), InputError);
  std::filesystem::remove(path);
  EXPECT_THROW(read_reproducer<2>(path), InputError);
}

TEST(Cut, FoldedSolidIsRefused) {
  Mesh folded;
  folded.points = {{0.2, 0.2}, {0.6, 0.2}, {0.4, 0.6}, {0.4, 0.5}};
  folded.cells = {{0, 1, 2}, {0, 1, 3}};
  EXPECT_THROW(cut_mesh<2>(box_mesh(0, 0, 1, 1, 2, 2), Solids{folded}, {}), NumericsError);
}

TEST(Cut, ThreeDimensionsByTheSameCode) {
  const std::array<std::array<int, 3>, 6> orders{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  const auto cube = [&orders](const Point<3>& corner, double size, const Eigen::Matrix3d& turn) {
    SimplexMesh<3> mesh;
    for (int i = 0; i < 8; ++i)
      mesh.points.push_back(corner + size * turn * Point<3>(i & 1, (i >> 1) & 1, (i >> 2) & 1));
    for (int k = 0; k < 6; ++k) {
      const int a = 1 << orders[k][0];
      const int b = a | (1 << orders[k][1]);
      mesh.cells.push_back({0, a, b, 7});
      if (k >= 3) std::swap(mesh.cells.back()[1], mesh.cells.back()[2]);
    }
    return mesh;
  };
  const auto background = cube({0, 0, 0}, 1, Eigen::Matrix3d::Identity());
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.3, Point<3>(1, 2, 3).normalized()).toRotationMatrix();
  for (const auto& solid :
       {cube({0.3, 0.3, 0.2}, 0.4, turn), cube({0.25, 0.25, 0.25}, 0.5, Eigen::Matrix3d::Identity())}) {
    const double size = std::cbrt(cell_measure(solid, 0) * 6);
    const auto cut = cut_mesh<3>(background, std::array{solid}, {});
    double volume = 0;
    double interface = 0;
    for (const auto& part : cut.parts) volume += part.measure;
    for (const double w : cut.interface_quadrature.weights) interface += w;
    EXPECT_NEAR(volume, 1 - size * size * size, 1e-13);
    EXPECT_NEAR(interface, 6 * size * size, 1e-13);
  }
}

} // namespace
} // namespace undula::geometry
