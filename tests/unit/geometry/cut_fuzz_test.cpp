// Random solids through the cut: polygons, thin curved plates, several bodies, bodies in contact with each
// other and the boundary, coordinates that coincide exactly, at three scales. The invariants are computed
// apart from the cut, and the cut in floating point is compared with the one in exact arithmetic.
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <random>

#include "cut_invariants.hpp"
#include "rom/base/error.hpp"

namespace undula::geometry {
namespace {

using namespace test;

/// The unit square, structured or with its inner points moved.
Mesh random_background(Fuzz& fuzz) {
  const int n = fuzz.integer(3, 6);
  auto mesh = box_mesh(0, 0, 1, 1, n, n);
  if (fuzz.chance(0.5))
    for (auto& p : mesh.points)
      if (p.minCoeff() > 0 && p.maxCoeff() < 1)
        p += Point<2>(fuzz.uniform(-0.25, 0.25), fuzz.uniform(-0.25, 0.25)) / n;
  return mesh;
}

/// A star around `centre`, fanned from it.
Mesh star(Fuzz& fuzz, const Point<2>& centre, double size) {
  Mesh mesh;
  const int n = fuzz.integer(3, 12);
  const double start = fuzz.uniform(0, 6);
  mesh.points.push_back(centre);
  for (int i = 0; i < n; ++i) {
    const double angle = start + 2 * std::numbers::pi * (i + fuzz.uniform(-0.1, 0.1)) / n;
    mesh.points.push_back(centre + size * fuzz.uniform(0.3, 1) * Point<2>(std::cos(angle), std::sin(angle)));
    mesh.cells.push_back({0, 1 + i, 1 + (i + 1) % n});
  }
  return mesh;
}

/// A bent plate through `centre`, some of them but a few hundred rounding errors thick.
Mesh plate(Fuzz& fuzz, const Point<2>& centre, double length) {
  auto mesh = box_mesh(-length / 2, -0.5, length / 2, 0.5, fuzz.integer(4, 30), fuzz.integer(1, 2));
  const double thickness = std::pow(10.0, fuzz.chance(0.2) ? fuzz.uniform(-13, -5) : fuzz.uniform(-5, -1.3));
  const double height = fuzz.uniform(0, 0.12) * length;
  const double wave = fuzz.uniform(2, 7) / length;
  const double phase = fuzz.uniform(0, 6);
  for (auto& p : mesh.points) p[1] = thickness * p[1] + height * std::sin(wave * p[0] + phase);
  return moved(mesh, centre, fuzz.uniform(0, 6));
}

/// Boxes and triangles with coordinates on multiples of 1 / n: points, edges and facets of the background
/// coincide with theirs.
Mesh on_lattice(Fuzz& fuzz, int n, const Point<2>& low, const Point<2>& high) {
  const auto line = [&](double from, double to) {
    return std::pair{static_cast<int>(std::ceil(from * n)), static_cast<int>(std::floor(to * n))};
  };
  const auto [x0, x1] = line(low[0], high[0]);
  const auto [y0, y1] = line(low[1], high[1]);
  const int left = fuzz.integer(x0, x1 - 1), bottom = fuzz.integer(y0, y1 - 1);
  const int right = fuzz.integer(left + 1, x1), top = fuzz.integer(bottom + 1, y1);
  const auto at = [n](int i) { return static_cast<double>(i) / n; };
  auto mesh = box_mesh(at(left), at(bottom), at(right), at(top), fuzz.integer(1, 3), fuzz.integer(1, 2));
  if (fuzz.chance(0.3)) {
    mesh.points = {{at(left), at(bottom)}, {at(right), at(bottom)}, {at(left), at(top)}};
    mesh.cells = {{0, 1, 2}};
  }
  mesh.boundary.clear();
  return mesh;
}

/// Triangles with corners on multiples of 1/8, some of which touch each other in points or along edges, none
/// of which overlap.
Solids lattice_triangles(Fuzz& fuzz) {
  Solids solids;
  for (int trial = 0; trial < 6; ++trial) {
    Mesh triangle;
    for (int v = 0; v < 3; ++v)
      triangle.points.push_back(Point<2>(fuzz.integer(-1, 9), fuzz.integer(-1, 9)) / 8);
    triangle.cells = {{0, 1, 2}};
    if (cell_measure(triangle, 0) == 0) continue;
    if (cell_measure(triangle, 0) < 0) std::swap(triangle.points[1], triangle.points[2]);
    bool overlaps = false;
    for (const auto& other : solids) {
      const auto shared = clipped(cell_polygon(other, 0), cell_polygon(triangle, 0));
      overlaps = overlaps || (!shared.empty() && moment(shared, 0, 0) > 1e-12L);
    }
    if (!overlaps) solids.push_back(triangle);
  }
  return solids;
}

struct Scene {
  Mesh background;
  Solids solids;
  Solids upright; ///< before the scene was turned
  double size;    ///< edge of the square, cm
};

Scene random_scene(int seed) {
  Fuzz fuzz(seed);
  Scene scene{random_background(fuzz), {}, {}, 1};
  const auto inside = [&] { return Point<2>(fuzz.uniform(0, 1), fuzz.uniform(0, 1)); };
  switch (seed % 6) {
    case 0:
      scene.solids.push_back(star(fuzz, inside(), fuzz.uniform(0.05, 0.6)));
      break;
    case 1:
      scene.solids.push_back(plate(fuzz, inside(), fuzz.uniform(0.2, 2)));
      break;
    case 2: // several bodies, each in a quarter of its own
      for (const Point<2>& quarter : {Point<2>(0, 0), Point<2>(0.5, 0), Point<2>(0, 0.5), Point<2>(0.5, 0.5)})
        if (fuzz.chance(0.7)) {
          const Point<2> centre = quarter + Point<2>(fuzz.uniform(0.2, 0.3), fuzz.uniform(0.2, 0.3));
          scene.solids.push_back(fuzz.chance(0.5) ? star(fuzz, centre, 0.19) : plate(fuzz, centre, 0.3));
        }
      break;
    case 3: { // coincidences with the structured background, and with the boundary from both sides
      const int n = fuzz.integer(3, 6);
      scene.background = box_mesh(0, 0, 1, 1, n, n);
      scene.solids.push_back(on_lattice(fuzz, n * fuzz.integer(1, 2), {-0.4, -0.4}, {1.4, 1.4}));
      break;
    }
    case 4: { // bodies that touch each other along x = 1/2
      const int n = 2 * fuzz.integer(2, 3);
      scene.background = fuzz.chance(0.5) ? box_mesh(0, 0, 1, 1, n, n) : random_background(fuzz);
      scene.solids.push_back(on_lattice(fuzz, n, {-0.3, 0}, {0.5, 1}));
      scene.solids.push_back(on_lattice(fuzz, n, {0.5, 0}, {1.3, 1}));
      if (fuzz.chance(0.5)) scene.solids.push_back(star(fuzz, {0.5, 1.5}, 0.49));
      break;
    }
    default:
      scene.solids = lattice_triangles(fuzz); // in contact inside the elements
  }
  // Nearly coincident: a rounding error apart.
  if ((seed % 6 == 3 || seed % 6 == 4) && fuzz.chance(0.2)) {
    const double shift = std::pow(10.0, -fuzz.integer(6, 17));
    for (auto& solid : scene.solids) solid = moved(solid, Point<2>(0, shift));
  }
  const double scale = std::array{1e-3, 1.0, 1e3}[seed / 6 % 3];
  scene.size = scale;
  scene.upright = scene.solids;
  for (auto& solid : scene.upright) solid = moved(solid, Point<2>(0, 0), 0, scale);
  // Turned, what coincides is a rounding error apart or overlaps by one; the latter is allowed to one solid.
  const bool single = scene.solids.size() == 1;
  const double turn = single && fuzz.chance(0.4) ? fuzz.uniform(0, 6) : 0;
  scene.background = moved(scene.background, Point<2>(0, 0), turn, scale);
  for (auto& solid : scene.solids) solid = moved(solid, Point<2>(0, 0), turn, scale);
  return scene;
}

void expect_invariants(const Scene& scene, const CutMesh<2>& cut) {
  const double size = scene.size;
  expect_moments(cut, scene.solids, 1e-12);
  expect_closed(cut, 1e-12);
  for (const auto& part : cut.parts) {
    EXPECT_GE(part.measure, 0);
    EXPECT_EQ(part.cut, part.simplex_end > part.simplex_begin);
  }
  for (const auto& connection : cut.connections) EXPECT_GE(connection.measure, 0);
  // Skin that other solids or the boundary lie against is seen once or not at all.
  double skin = 0;
  for (const double w : cut.interface_quadrature.weights) skin += w;
  const double expected = skin_in_box(scene.upright, 0, 0, size, size);
  EXPECT_LE(skin, expected + 1e-12 * (size + expected));
}

struct CellSummary {
  std::vector<double> measures;
  double interface = 0;
};

void expect_same(const CutMesh<2>& a, const CutMesh<2>& b, double size) {
  const auto by_cell = [](const CutMesh<2>& cut) {
    std::vector<CellSummary> cells(cut.mesh.cells.size());
    for (const auto& part : cut.parts) cells[part.cell].measures.push_back(part.measure);
    for (auto& cell : cells) std::sort(cell.measures.begin(), cell.measures.end());
    for (const auto& piece : cut.interface)
      for (int q = piece.quadrature_begin; q < piece.quadrature_end; ++q)
        cells[cut.parts[piece.part].cell].interface += cut.interface_quadrature.weights[q];
    return cells;
  };
  const auto cells_a = by_cell(a), cells_b = by_cell(b);
  for (std::size_t c = 0; c < cells_a.size(); ++c) {
    ASSERT_EQ(cells_a[c].measures.size(), cells_b[c].measures.size()) << "parts of cell " << c;
    for (std::size_t i = 0; i < cells_a[c].measures.size(); ++i)
      ASSERT_NEAR(cells_a[c].measures[i], cells_b[c].measures[i], 1e-13 * size * size) << "cell " << c;
    // Skin along a facet may be seen from the other side of the facet: nothing decides but the exact cut.
    ASSERT_NEAR(cells_a[c].interface, cells_b[c].interface, 1e-12 * size) << "interface in cell " << c;
  }
  expect_same_facets(a, b, 1e-13 * size);
  if (testing::Test::HasFatalFailure()) return;
  ASSERT_EQ(a.boundary.size(), b.boundary.size());
  ASSERT_EQ(build_dof_sets(a).dof_point, build_dof_sets(b).dof_point);
}

void run_scenes(int begin, int end, int compare_every) {
  int filtered = 0, exact = 0;
  double seconds = 0;
  for (int seed = begin; seed < end; ++seed) {
    SCOPED_TRACE("scene " + std::to_string(seed));
    const auto scene = random_scene(seed);
    const auto start = std::chrono::steady_clock::now();
    CutMesh<2> cut;
    ASSERT_NO_THROW(cut = cut_mesh<2>(scene.background, scene.solids, {}));
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    filtered += cut.filtered_cells;
    exact += cut.exact_cells;
    expect_invariants(scene, cut);
    if (seed / 6 % compare_every == 0) {
      CutOptions options;
      options.exact = true;
      const auto reference = cut_mesh<2>(scene.background, scene.solids, options);
      EXPECT_EQ(reference.filtered_cells, 0);
      expect_same(cut, reference, scene.size);
    }
    if (testing::Test::HasFailure()) return;
  }
  std::printf("%d scenes: %d cells cut in floating point, %d in exact arithmetic, %.2f s in the cut\n",
              end - begin, filtered, exact, seconds);
  EXPECT_GT(filtered, 0);
  EXPECT_GT(exact, 0);
}

TEST(CutFuzz, RandomScenes) { run_scenes(0, 1500, 10); }
TEST(CutFuzz, DISABLED_TenThousandRandomScenes) { run_scenes(0, 10000, 10); }

std::string scratch() {
  const auto directory = std::filesystem::temp_directory_path() / "undula_cut_fuzz";
  std::filesystem::create_directories(directory);
  return directory.string();
}

TEST(CutFuzz, OverlappingSolidsAreRefused) {
  CutOptions options;
  options.reproducer_directory = scratch();
  int overlapping = 0;
  for (int seed = 0; seed < 1000; ++seed) {
    SCOPED_TRACE(seed);
    Fuzz fuzz(seed);
    const auto background = random_background(fuzz);
    const auto body = [&](const Point<2>& at, double size) {
      return fuzz.chance(0.5) ? star(fuzz, at, size) : plate(fuzz, at, 2 * size);
    };
    const Point<2> at(fuzz.uniform(0.3, 0.7), fuzz.uniform(0.3, 0.7));
    Solids solids{body(at, 0.25)};
    // From grazing to one inside the other.
    const double apart = fuzz.uniform(0, 0.4), turn = fuzz.uniform(0, 6);
    solids.push_back(body(at + apart * Point<2>(std::cos(turn), std::sin(turn)), fuzz.uniform(0.01, 0.2)));
    double overlap = 0;
    for (int a = 0; a < static_cast<int>(solids[0].cells.size()); ++a)
      for (int b = 0; b < static_cast<int>(solids[1].cells.size()); ++b)
        if (const auto shared = clipped(cell_polygon(solids[0], a), cell_polygon(solids[1], b));
            !shared.empty())
          overlap += static_cast<double>(moment(shared, 0, 0));
    if (overlap > 1e-9) {
      ++overlapping;
      EXPECT_THROW(cut_mesh<2>(background, solids, options), NumericsError);
    } else if (overlap == 0) {
      EXPECT_NO_THROW(cut_mesh<2>(background, solids, options));
    }
  }
  EXPECT_GT(overlapping, 200);
  EXPECT_LT(overlapping, 800);
  std::filesystem::remove_all(scratch());
}

TEST(CutFuzz, OneSolidInsideAnotherIsRefused) {
  CutOptions options;
  options.reproducer_directory = scratch();
  const auto background = box_mesh(0, 0, 1, 1, 8, 8);
  for (const double size : {0.4, 0.2, 0.05, 0.01}) // over many elements, and within one
    for (const double turn : {0.0, 0.3})
      EXPECT_THROW(cut_mesh<2>(background,
                               Solids{box_mesh(0.1, 0.1, 0.9, 0.9, 3, 3),
                                      moved(box_mesh(0, 0, size, size, 2, 2), {0.43, 0.39}, turn)},
                               options),
                   NumericsError)
          << size << " " << turn;
  std::filesystem::remove_all(scratch());
}

TEST(CutFuzz, SolidsThatTouchInAPointPartTheFluid) {
  Mesh background, left, right;
  background.points = {{0, 0}, {1, 0}, {0, 1}};
  background.cells = left.cells = right.cells = {{0, 1, 2}};
  left.points = {{-1, 0.2}, {0.25, 0.25}, {-1, 0.3}};
  right.points = {{0.25, 0.25}, {2, 0.2}, {2, 0.3}};
  const auto cut = cut_mesh<2>(background, Solids{left, right}, {});
  EXPECT_EQ(cut.parts.size(), 2u);
  expect_moments(cut, {left, right}, 1e-12);
  expect_closed(cut, 1e-12);
  // Apart by the thickness of a hair, the fluid is one.
  const Solids apart{left, moved(right, Point<2>(1e-9, 0))};
  const auto open = cut_mesh<2>(background, apart, {});
  EXPECT_EQ(open.parts.size(), 1u);
  EXPECT_EQ(open.exact_cells, 0);
  expect_moments(open, apart, 1e-12);
}

TEST(CutFuzz, SolidThatCrossesItselfIsRefused) {
  // An annulus of one and a bit turns: every cell is positively oriented, the ends overlap.
  Mesh ring = box_mesh(0, 0, 1, 1, 40, 1);
  for (auto& p : ring.points) {
    const double angle = 6.6 * p[0];
    p = Point<2>(0.5, 0.5) + (0.4 - 0.1 * p[1]) * Point<2>(std::cos(angle), std::sin(angle));
  }
  ring.boundary.clear();
  EXPECT_THROW(cut_mesh<2>(box_mesh(0, 0, 1, 1, 6, 6), Solids{ring}, {}), NumericsError);
}

TEST(CutFuzz, SolidsAtNoPlaceOrTurnedInsideOutAreRefused) {
  const auto background = box_mesh(0, 0, 1, 1, 6, 6);
  const Solids body{moved(box_mesh(0, 0, 0.4, 0.1, 6, 2), {0.31, 0.42}, 0.2)};
  const BackgroundCutter<2> cutter(background, body, {});
  ASSERT_NO_THROW(cutter.cut(body));
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e300 * 1e300}) {
    auto solids = body;
    solids[0].points[5][1] = bad;
    EXPECT_THROW(cutter.cut(solids), NumericsError);
  }
  auto solids = body;
  std::swap(solids[0].points[8], solids[0].points[9]);
  EXPECT_THROW(cutter.cut(solids), NumericsError);
  solids = body;
  solids[0].points[0] = solids[0].points[1]; // flat
  EXPECT_THROW(cutter.cut(solids), NumericsError);
  solids = body;
  solids[0].cells.pop_back();
  EXPECT_THROW(cutter.cut(solids), InputError);
  EXPECT_THROW(cutter.cut({}), InputError);
}

TEST(CutFuzz, RepeatedCutsOfOneBackgroundEqualFreshOnes) {
  const auto background = box_mesh(0, 0, 1, 1, 7, 7);
  const Mesh body = box_mesh(-0.3, -0.02, 0.3, 0.02, 9, 2);
  const BackgroundCutter<2> cutter(background, Solids{body}, {});
  for (int step = 0; step < 50; ++step) {
    const Solids placed{moved(body, {0.4 + 0.004 * step, 0.5}, 0.05 * step)};
    const auto again = cutter.cut(placed), fresh = cut_mesh<2>(background, placed, {});
    ASSERT_EQ(again.volume_quadrature.weights, fresh.volume_quadrature.weights);
    ASSERT_EQ(again.interface_quadrature.weights, fresh.interface_quadrature.weights);
    ASSERT_EQ(again.connections.size(), fresh.connections.size());
  }
}

} // namespace
} // namespace undula::geometry
