#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>

#include "geometry/mesh/mesh_quality.hpp"
#include "geometry/mesh/space_mesh.hpp"
#include "rom/base/error.hpp"

namespace undula::geometry {
namespace {

/// r from 0.5 to 1, z from 0 to 0.4, with a groove in the outer wall.
TaggedPolygon ring() {
  TaggedPolygon profile;
  profile.points = {{0.5, 0}, {1, 0}, {1, 0.15}, {0.85, 0.15}, {0.85, 0.25}, {1, 0.25}, {1, 0.4}, {0.5, 0.4}};
  profile.tags = {0, 1, 1, 1, 1, 1, 2, 3};
  profile.names = {"bottom", "outer", "top", "inner"};
  return profile;
}

TaggedPolygon cone() {
  TaggedPolygon profile;
  profile.points = {{0, 0}, {1, 0}, {0, 1}};
  profile.tags = {0, 1, 2};
  profile.names = {"base", "mantle", "axis"};
  return profile;
}

std::map<std::string, double> areas(const SimplexMesh<3>& mesh) {
  std::map<std::string, double> sum;
  for (const auto& facet : build_facet_table(mesh).facets) {
    if (facet.cells[1] >= 0) continue;
    EXPECT_GE(facet.boundary_tag, 0);
    sum[mesh.boundary_names[facet.boundary_tag]] += facet_measure(mesh, facet);
  }
  return sum;
}

double mean_edge(const SimplexMesh<3>& mesh) {
  double sum = 0;
  for (const auto& cell : mesh.cells)
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j) sum += (mesh.points[cell[i]] - mesh.points[cell[j]]).norm();
  return sum / (6.0 * static_cast<double>(mesh.cells.size()));
}

TEST(RevolvedMesh, ASectorOfARingHasItsFacesEdgesAndNames) {
  const double angle = 30 * std::numbers::pi / 180;
  const auto mesh = mesh_revolved(ring(), 30, [](const Point<3>&) { return 0.06; });
  const auto quality = mesh_quality(mesh);
  std::printf("%d cells, angles %.1f to %.1f, mean edge %.4f for 0.06\n", quality.cells, quality.min_angle,
              quality.max_angle, mean_edge(mesh));
  const double section = 0.5 * 0.4 - 0.15 * 0.1;
  const double volume = angle / 2 * ((1 - 0.25) * 0.4 - (1 - 0.85 * 0.85) * 0.1);
  EXPECT_NEAR(quality.volume, volume, 2e-3 * volume);
  EXPECT_LT(quality.volume, volume + 1e-3 * volume);
  EXPECT_GT(quality.min_angle, 5);
  EXPECT_NEAR(mean_edge(mesh), 0.06, 0.012);
  auto area = areas(mesh);
  EXPECT_NEAR(area["symmetry"], 2 * section, 1e-12); // planes and straight edges: exact
  EXPECT_NEAR(area["bottom"], angle / 2 * 0.75, 2e-3);
  EXPECT_NEAR(area["top"], angle / 2 * 0.75, 2e-3);
  EXPECT_NEAR(area["inner"], angle * 0.5 * 0.4, 2e-3);
  EXPECT_NEAR(area["outer"], angle * (0.3 + 0.085) + angle * (1 - 0.85 * 0.85), 2e-3);
  for (const auto& facet : mesh.boundary)
    for (const int p : facet.points) {
      const auto& x = mesh.points[p];
      const std::string& name = mesh.boundary_names[facet.tag];
      if (name == "bottom") {
        EXPECT_EQ(x.z(), 0);
      } else if (name == "inner") {
        EXPECT_NEAR(std::hypot(x.x(), x.y()), 0.5, 1e-14);
      } else if (name == "symmetry") {
        EXPECT_LT(std::min(std::abs(x.y()), std::abs(std::cos(angle) * x.y() - std::sin(angle) * x.x())),
                  1e-15);
      }
    }
}

TEST(RevolvedMesh, AWholeConeTouchesTheAxis) {
  for (const double sector : {360.0, 90.0}) {
    const auto mesh = mesh_revolved(cone(), sector, [](const Point<3>&) { return 0.15; });
    const double share = sector / 360;
    const auto quality = mesh_quality(mesh);
    EXPECT_NEAR(quality.volume, share * std::numbers::pi / 3, 0.03 * share);
    auto area = areas(mesh);
    EXPECT_NEAR(area["base"], share * std::numbers::pi, 0.05 * share);
    EXPECT_NEAR(area["mantle"], share * std::numbers::pi * std::numbers::sqrt2, 0.08 * share);
    EXPECT_EQ(area["axis"], 0);
    EXPECT_NEAR(area["symmetry"], sector < 360 ? 1 : 0, 1e-12);
  }
}

TEST(RevolvedMesh, VolumeConvergesWithTheSquareOfTheSize) {
  TaggedPolygon profile;
  profile.points = {{0, 0}, {1, 0}, {1, 0.5}, {0, 0.5}};
  profile.tags = {0, 1, 2, 3};
  profile.names = {"bottom", "wall", "top", "axis"};
  double last = 0;
  for (const double h : {0.24, 0.1}) {
    const double volume =
        mesh_quality(mesh_revolved(profile, 360, [h](const Point<3>&) { return h; })).volume;
    const double error = 0.5 * std::numbers::pi - volume;
    EXPECT_GT(error, 0); // chords
    if (last > 0) {
      EXPECT_LT(error, last / 3.5);
    }
    last = error;
  }
}

TEST(RevolvedMesh, FollowsTheSizeFieldAndRepeatsItself) {
  const auto size = [](const Point<3>& x) { return 0.05 + 0.2 * std::abs(x.z() - 0.1); };
  const auto mesh = mesh_revolved(ring(), 60, size), again = mesh_revolved(ring(), 60, size);
  EXPECT_EQ(mesh.cells, again.cells);
  EXPECT_EQ(mesh.points, again.points);
  EXPECT_GT(mesh_quality(mesh).min_angle, 5);
  double fine = 0, coarse = 0;
  int fine_count = 0, coarse_count = 0;
  for (int c = 0; c < static_cast<int>(mesh.cells.size()); ++c) {
    const double z = mesh.points[mesh.cells[c][0]].z();
    if (std::abs(z - 0.1) < 0.03) fine += cell_diameter(mesh, c), ++fine_count;
    if (z > 0.35) coarse += cell_diameter(mesh, c), ++coarse_count;
  }
  EXPECT_GT(coarse / coarse_count, 1.4 * fine / fine_count);
}

TEST(RevolvedMesh, RefusesWhatIsNoBody) {
  const auto size = [](const Point<3>&) { return 0.1; };
  auto bad = ring();
  bad.points[0].x() = -0.1;
  EXPECT_THROW(mesh_revolved(bad, 360, size), InputError);
  bad = ring();
  std::swap(bad.points[0], bad.points[1]);
  EXPECT_THROW(mesh_revolved(bad, 360, size), InputError);
  bad = ring();
  bad.tags.pop_back();
  EXPECT_THROW(mesh_revolved(bad, 360, size), InputError);
  EXPECT_THROW(mesh_revolved(ring(), 0, size), InputError);
  EXPECT_THROW(mesh_revolved(ring(), 400, size), InputError);
  EXPECT_THROW(mesh_revolved(
                   ring(), 360, [](const Point<3>&) { return 0.02; }, 500),
               InputError);
}

} // namespace
} // namespace undula::geometry
