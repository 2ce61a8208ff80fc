#include "geometry/wave_pump/pump.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "geometry/mesh/mesh_quality.hpp"
#include "rom/base/error.hpp"
#include "simple_pump.hpp"

namespace undula::geometry {
namespace {

PumpProfile wave_pump() {
  return read_pump_profile(std::string(UNDULA_SOURCE_DIR) + "/data/profiles/wave_pump_profile.toml");
}

constexpr PumpMeshSizes sizes{4, 0.12, 0.08, 0.3};

std::array<double, 5> boundary_lengths(const SimplexMesh<2>& mesh) {
  std::array<double, 5> length{};
  for (const auto& facet : mesh.boundary)
    length[facet.tag] += (mesh.points[facet.points[1]] - mesh.points[facet.points[0]]).norm();
  return length;
}

TEST(Clearance, IsTheWidthOfTheGap) {
  const auto profile = simple_pump();
  EXPECT_NEAR(local_clearance(profile, {1.5, 0.3}), 0.4, 1e-14);   // above the membrane
  EXPECT_NEAR(local_clearance(profile, {1.5, -0.12}), 0.4, 1e-14); // below
  EXPECT_NEAR(local_clearance(profile, {2.95, 0.0}), 0.1, 1e-14);  // rim
  EXPECT_NEAR(local_clearance(profile, {2.1, 1.05}), 0.3, 1e-14);  // magnet to stator
  EXPECT_NEAR(local_clearance(profile, {1.5, 0.05}), 0.4, 1e-14);  // inside the membrane
}

TEST(Clearance, BridgesFindTheGapsOfTheWavePump) {
  double narrowest = 1;
  for (const auto& bridge : gap_bridges(wave_pump(), 0.2, 0.1)) {
    EXPECT_LT(bridge.width(), 0.2);
    narrowest = std::min(narrowest, bridge.width());
  }
  EXPECT_NEAR(narrowest, 0.054, 1e-12); // rim gap
}

TEST(Clearance, SizeIsWidthOverElementsAcrossTheWholeGap) {
  const auto size = pump_size_field(simple_pump(), sizes);
  for (const double z : {0.1, 0.2, 0.3, 0.4, 0.5}) EXPECT_NEAR(size({1.5, z}), 0.1, 0.004);
  for (const double r : {2.9, 2.925, 2.95, 3.0}) EXPECT_NEAR(size({r, 0.0}), 0.025, 1e-3);
  EXPECT_NEAR(size({2.1, 1.05}), 0.075, 1e-3);
  EXPECT_EQ(size({0.2, -1.9}), 0.12); // outlet channel, far from every gap
}

TEST(Clearance, SizeGrowsNoFasterThanAsked) {
  const auto size = pump_size_field(wave_pump(), sizes);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> r(0, 2.5), z(-0.9, 3.79);
  for (int i = 0; i < 2000; ++i) {
    const Point<2> x(r(random), z(random)), y(r(random), z(random));
    EXPECT_LE(std::abs(size(x) - size(y)), sizes.growth * (x - y).norm() + 1e-14);
  }
}

TEST(Clearance, RefusesSizesThatMakeNoSense) {
  for (const PumpMeshSizes& wrong : {PumpMeshSizes{1, 0.1, 0.1, 0.3}, PumpMeshSizes{4, 0, 0.1, 0.3},
                                     PumpMeshSizes{4, 0.1, -1, 0.3}, PumpMeshSizes{4, 0.1, 0.1, -0.1}})
    EXPECT_THROW(pump_background(simple_pump(), wrong), InputError);
}

TEST(Pump, BackgroundHasTheExactAreaAndSides) {
  const auto mesh = pump_background(simple_pump(), sizes);
  EXPECT_EQ(mesh.boundary_names, (std::vector<std::string>{"housing", "stator", "axis", "inlet", "outlet"}));
  EXPECT_NEAR(mesh_quality(mesh).area, 6.75, 1e-12);
  const auto length = boundary_lengths(mesh);
  EXPECT_NEAR(length[0], 10, 1e-12);
  EXPECT_NEAR(length[1], 5, 1e-12);
  EXPECT_NEAR(length[2], 4, 1e-12);
  EXPECT_NEAR(length[3], 0.5, 1e-12);
  EXPECT_NEAR(length[4], 0.5, 1e-12);
}

TEST(Pump, WavePumpMeshIsSound) {
  const auto mesh = pump_background(wave_pump(), {5, 0.08, 0.05, 0.3});
  const auto quality = mesh_quality(mesh);
  EXPECT_NEAR(quality.area, 3.536611, 1e-9);
  EXPECT_GE(quality.min_angle, 25);
  EXPECT_GT(quality.cells, 4000);
  EXPECT_LT(quality.cells, 8000);
  for (const auto& facet : mesh.boundary)
    for (const int i : facet.points)
      if (mesh.boundary_names[facet.tag] == "axis") {
        EXPECT_EQ(mesh.points[i].x(), 0.0);
      }
}

TEST(Pump, BackgroundIsFineInBoxesAndAsBeforeFarFromThem) {
  const RefinementBox<2> box{{0.4, -0.1}, {0.6, 0.1}, 0.006};
  const auto plain = pump_background(wave_pump(), sizes),
             fine = pump_background(wave_pump(), sizes, std::span(&box, 1));
  const auto longest = [](const SimplexMesh<2>& mesh, const auto& counts) {
    double length = 0;
    for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
      Point<2> centre = Point<2>::Zero();
      for (const int point : mesh.cells[cell]) centre += mesh.points[point] / 3;
      if (counts(centre)) length = std::max(length, cell_diameter(mesh, static_cast<int>(cell)));
    }
    return length;
  };
  const auto inside = [&](const Point<2>& x) { return x == x.cwiseMax(box.low).cwiseMin(box.high); };
  const auto far = [](const Point<2>& x) { return x[1] > 1; };
  EXPECT_GT(longest(plain, inside), 0.02);
  EXPECT_LT(longest(fine, inside), 0.008 + 1e-12); // 4/3 of the size
  EXPECT_NEAR(longest(fine, far), longest(plain, far), 0.02);
  EXPECT_NEAR(mesh_quality(fine).area, mesh_quality(plain).area, 1e-9);
}

// With no-slip on both walls such an edge would stop the flow in a P1 space.
TEST(Pump, NoEdgeSpansAChannelFromWallToWall) {
  for (const double elements : {2.0, 3.0, 5.0}) {
    const auto mesh = pump_background(wave_pump(), {elements, 0.08, 0.05, 0.3});
    std::vector<int> wall(mesh.points.size(), -1);
    for (const auto& facet : mesh.boundary)
      if (facet.tag < 2)
        for (const int i : facet.points) wall[i] = facet.tag;
    for (const auto& cell : mesh.cells) {
      std::set<int> walls;
      for (const int i : cell) walls.insert(wall[i]);
      EXPECT_FALSE(walls.contains(0) && walls.contains(1));
    }
  }
}

TEST(Pump, MembraneHasTwoElementsThroughItsThickness) {
  const auto profile = wave_pump();
  const auto mesh = pump_membrane(profile, {5, 0.08, 0.05, 0.3});
  EXPECT_EQ(mesh.boundary_names, (std::vector<std::string>{"lower", "rim", "upper", "tip"}));
  EXPECT_NEAR(mesh_quality(mesh).area, 0.8 * 0.0875 + 1.146 * 0.12, 1e-13);
  const auto length = boundary_lengths(mesh);
  EXPECT_NEAR(length[0], std::hypot(0.8, 0.0325) + 1.146, 1e-13);
  EXPECT_NEAR(length[0], length[2], 1e-13);
  EXPECT_NEAR(length[1], 0.12, 1e-14);
  EXPECT_NEAR(length[3], 0.055, 1e-14);
  std::vector<int> side(mesh.points.size(), -1);
  for (const auto& facet : mesh.boundary)
    if (facet.tag == 0 || facet.tag == 2)
      for (const int i : facet.points) side[i] = facet.tag;
  for (const auto& cell : mesh.cells) {
    std::set<int> sides;
    for (const int i : cell) sides.insert(side[i]);
    EXPECT_FALSE(sides.contains(0) && sides.contains(2)); // no edge from skin to skin
  }
}

TEST(Pump, MembraneMeshFollowsTheClampRadius) {
  const auto profile = wave_pump();
  const auto mesh = pump_membrane(profile, {5, 0.08, 0.05, 0.3});
  const double clamp = profile.membrane.clamp_radius;
  double line = 0;
  for (const auto& cell : mesh.cells) {
    bool left = false, right = false;
    for (int i = 0; i < 3; ++i) {
      const auto& a = mesh.points[cell[i]];
      const auto& b = mesh.points[cell[(i + 1) % 3]];
      left |= a.x() < clamp;
      right |= a.x() > clamp;
      if (a.x() == clamp && b.x() == clamp) line += 0.5 * (b - a).norm(); // met from both sides
    }
    EXPECT_FALSE(left && right);
  }
  EXPECT_NEAR(line, 0.12, 1e-14);
}

TEST(Pump, MagnetIsMeshedFromEitherOrientation) {
  auto profile = simple_pump();
  const auto one = pump_magnet(profile, sizes);
  std::reverse(profile.magnet.points.begin(), profile.magnet.points.end());
  const auto two = pump_magnet(profile, sizes);
  EXPECT_NEAR(mesh_quality(one).area, 0.09, 1e-14);
  EXPECT_NEAR(mesh_quality(two).area, 0.09, 1e-14);
  EXPECT_NEAR(boundary_lengths(one)[0], 1.2, 1e-14);
}

} // namespace
} // namespace undula::geometry
