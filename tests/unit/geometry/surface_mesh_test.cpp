#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "geometry/mesh/box_mesh.hpp"
#include "geometry/mesh/mesh_quality.hpp"
#include "geometry/mesh/space_mesh.hpp"
#include "rom/base/error.hpp"

namespace undula::geometry {
namespace {

/// A scratch folder that goes with the test.
struct Scratch {
  std::filesystem::path folder =
      std::filesystem::temp_directory_path() /
      ("undula_surface_mesh_test_" + std::to_string(::getpid())); // tests run side by side
  Scratch() { std::filesystem::create_directories(folder); }
  ~Scratch() { std::filesystem::remove_all(folder); }
};

/// The boundary of a mesh, seen from outside counter-clockwise or not: files differ.
void write_off(const SimplexMesh<3>& mesh, std::size_t facets, const std::filesystem::path& file) {
  std::ofstream out(file);
  out.precision(17);
  out << "OFF\n" << mesh.points.size() << " " << facets << " 0\n";
  for (const auto& x : mesh.points) out << x.transpose() << "\n";
  for (std::size_t f = 0; f < facets; ++f) {
    out << 3;
    for (const int p : mesh.boundary[f].points) out << " " << p;
    out << "\n";
  }
}

void write_stl(const SimplexMesh<3>& mesh, const std::filesystem::path& file) {
  std::ofstream out(file);
  out.precision(17);
  out << "solid body\n";
  for (const auto& facet : mesh.boundary) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (const int p : facet.points) out << "vertex " << mesh.points[p].transpose() << "\n";
    out << "endloop\nendfacet\n";
  }
  out << "endsolid body\n";
}

/// A box pushed onto a sphere of radius 1.
SimplexMesh<3> ball() {
  auto mesh = box_mesh({{-1, -1, -1}, {1, 1, 1}}, {8, 8, 8});
  for (auto& x : mesh.points)
    if (x.norm() > 0) x *= x.lpNorm<Eigen::Infinity>() / x.norm();
  return mesh;
}

double volume_inside(const SimplexMesh<3>& mesh) { return mesh_quality(mesh).volume; }

TEST(SurfaceMesh, ABoxKeepsItsEdges) {
  const Scratch scratch;
  const auto box = box_mesh({{0, 0, 0}, {1, 2, 0.5}}, {2, 2, 1});
  write_off(box, box.boundary.size(), scratch.folder / "box.off");
  write_stl(box, scratch.folder / "box.stl");
  for (const char* name : {"box.off", "box.stl"}) {
    const auto mesh = mesh_closed_surface(scratch.folder / name, 2, [](const Point<3>&) { return 0.4; });
    const auto quality = mesh_quality(mesh);
    EXPECT_NEAR(quality.volume, 8, 1e-9) << name; // 2 x 4 x 1: planes and edges are exact
    EXPECT_GT(quality.cells, 500);
    EXPECT_GT(quality.min_angle, 5);
    double area = 0;
    for (const auto& facet : build_facet_table(mesh).facets)
      if (facet.cells[1] < 0) {
        EXPECT_EQ(facet.boundary_tag, 0);
        area += facet_measure(mesh, facet);
      }
    EXPECT_NEAR(area, 28, 1e-9);
    EXPECT_EQ(mesh.boundary_names, std::vector<std::string>{surface_name});
  }
}

TEST(SurfaceMesh, ABallWithoutSharpEdgesIsFilled) {
  const Scratch scratch;
  const auto sphere = ball();
  write_off(sphere, sphere.boundary.size(), scratch.folder / "ball.off");
  const auto size = [](const Point<3>& x) { return 0.15 + 0.2 * (1 - x.norm()); };
  const auto mesh = mesh_closed_surface(scratch.folder / "ball.off", 1, size);
  const auto quality = mesh_quality(mesh);
  EXPECT_NEAR(quality.volume, volume_inside(sphere), 0.02 * quality.volume);
  EXPECT_GT(quality.min_angle, 5);
  const auto again = mesh_closed_surface(scratch.folder / "ball.off", 1, size);
  EXPECT_EQ(mesh.points, again.points);
  EXPECT_EQ(mesh.cells, again.cells);
}

TEST(SurfaceMesh, RefusesWhatBoundsNothing) {
  const Scratch scratch;
  const auto size = [](const Point<3>&) { return 0.5; };
  const auto box = box_mesh({{0, 0, 0}, {1, 1, 1}}, {1, 1, 1});
  const auto file = scratch.folder / "bad.off";
  EXPECT_THROW(mesh_closed_surface(file, 1, size), InputError); // absent
  write_off(box, box.boundary.size() - 1, file);                // open
  EXPECT_THROW(mesh_closed_surface(file, 1, size), InputError);
  auto crossing = box_mesh({{0, 0, 0}, {1, 1, 1}}, {1, 1, 1});
  crossing.points[0] = {0.5, 0.5, 3}; // through the top
  write_off(crossing, crossing.boundary.size(), file);
  EXPECT_THROW(mesh_closed_surface(file, 1, size), InputError);
  std::ofstream(file) << "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
  EXPECT_THROW(mesh_closed_surface(file, 1, size), InputError);
  std::ofstream(file) << "nothing\n";
  EXPECT_THROW(mesh_closed_surface(file, 1, size), InputError);
}

} // namespace
} // namespace undula::geometry
