#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "geometry/mesh/gmsh_import.hpp"
#include "geometry/mesh/mesh_quality.hpp"
#include "rom/base/error.hpp"

namespace undula::geometry {
namespace {

const std::filesystem::path fixtures = std::filesystem::path(UNDULA_SOURCE_DIR) /
                                       "tests/unit/geometry/fixtures"; // written by Gmsh 4.8, see each test

template <int dim>
std::string message_of(const std::filesystem::path& file) {
  try {
    import_gmsh<dim>(file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string read(const std::string& name) {
  std::ifstream in(fixtures / name);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A fixture with `from` replaced by `to`, in a file of its own.
std::filesystem::path changed(const std::string& name, const std::string& from, const std::string& to) {
  auto text = read(name);
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const auto file = std::filesystem::path(testing::TempDir()) / (std::string(test->name()) + ".msh");
  std::ofstream(file) << text;
  return file;
}

std::map<std::string, double> side_lengths(const SimplexMesh<2>& mesh) {
  std::map<std::string, double> length;
  for (const auto& facet : mesh.boundary)
    length[mesh.boundary_names[facet.tag]] +=
        (mesh.points[facet.points[1]] - mesh.points[facet.points[0]]).norm();
  return length;
}

// A rectangle 2 x 1 with sides "wall" (bottom and top), "outlet" (right), "inlet" (left).
TEST(Gmsh, ReadsARectangleInBothVersions) {
  for (const auto* name : {"rectangle_22.msh", "rectangle_41.msh"}) {
    const auto imported = import_gmsh<2>(fixtures / name);
    const auto quality = mesh_quality(imported.mesh);
    EXPECT_EQ(quality.cells, 8) << name;
    EXPECT_EQ(quality.points, 8) << name;
    EXPECT_NEAR(quality.area, 2, 1e-14) << name;
    EXPECT_EQ(imported.reoriented_cells, 0) << name;
    const auto length = side_lengths(imported.mesh);
    ASSERT_EQ(length.size(), 3u) << name;
    EXPECT_NEAR(length.at("wall"), 4, 1e-14) << name;
    EXPECT_NEAR(length.at("inlet"), 1, 1e-14) << name;
    EXPECT_NEAR(length.at("outlet"), 1, 1e-14) << name;
    for (const auto& facet : imported.mesh.boundary)
      for (const int i : facet.points) {
        const double x = imported.mesh.points[i].x();
        if (imported.mesh.boundary_names[facet.tag] == "outlet") {
          EXPECT_EQ(x, 2);
        }
      }
  }
}

// The unit cube: "ends" are two of its faces, "wall" the others.
TEST(Gmsh, ReadsACube) {
  const auto imported = import_gmsh<3>(fixtures / "cube_41.msh");
  const auto& mesh = imported.mesh;
  double volume = 0;
  for (const auto& cell : mesh.cells) {
    Eigen::Matrix3d edges;
    for (int i = 0; i < 3; ++i) edges.col(i) = mesh.points[cell[i + 1]] - mesh.points[cell[0]];
    EXPECT_GT(edges.determinant(), 0);
    volume += edges.determinant() / 6;
  }
  EXPECT_NEAR(volume, 1, 1e-13);
  std::map<std::string, double> area;
  for (const auto& facet : mesh.boundary) {
    const auto& a = mesh.points[facet.points[0]];
    const Point<3> u = mesh.points[facet.points[1]] - a, v = mesh.points[facet.points[2]] - a;
    area[mesh.boundary_names[facet.tag]] += 0.5 * u.cross(v).norm();
  }
  EXPECT_NEAR(area.at("wall"), 4, 1e-13);
  EXPECT_NEAR(area.at("ends"), 2, 1e-13);
}

TEST(Gmsh, TurnsInvertedCellsRoundAndCountsThem) {
  const auto imported = import_gmsh<2>(fixtures / "inverted_22.msh");
  EXPECT_EQ(imported.reoriented_cells, 2);
  EXPECT_NEAR(mesh_quality(imported.mesh).area, 2, 1e-14); // signed areas
}

TEST(Gmsh, LeavesOutNodesWithoutACell) {
  const auto file = changed("rectangle_22.msh", "$Nodes\n8\n", "$Nodes\n9\n77 5 5 0\n");
  EXPECT_EQ(import_gmsh<2>(file).mesh.points.size(), 8u);
}

TEST(Gmsh, ToleratesRoundingOffThePlaneOnly) {
  EXPECT_NO_THROW(import_gmsh<2>(changed("rectangle_22.msh", "3 2 1 0\n", "3 2 1 1e-16\n")));
  const auto message = message_of<2>(changed("rectangle_22.msh", "3 2 1 0\n", "3 2 1 0.5\n"));
  EXPECT_NE(message.find("off the plane"), std::string::npos) << message;
}

TEST(Gmsh, RefusesWhatIsNoAsciiMeshFile) {
  EXPECT_NE(message_of<2>(fixtures / "missing.msh").find("no such file"), std::string::npos);
  EXPECT_NE(message_of<2>(fixtures / "rectangle_binary.msh").find("binary"), std::string::npos);
  const auto foreign = std::filesystem::path(UNDULA_SOURCE_DIR) / "CMakeLists.txt";
  EXPECT_NE(message_of<2>(foreign).find("not a Gmsh file"), std::string::npos);
  const auto version = message_of<2>(changed("rectangle_41.msh", "4.1 0 8", "4.0 0 8"));
  EXPECT_NE(version.find("'4.0'"), std::string::npos) << version;
}

TEST(Gmsh, RefusesEveryTruncation) {
  for (const auto* name : {"rectangle_22.msh", "rectangle_41.msh"}) {
    const auto text = read(name);
    const auto file = std::filesystem::path(testing::TempDir()) / "truncated.msh";
    for (std::size_t length = 0; length + 1 < text.size(); length += 7) {
      std::ofstream(file) << text.substr(0, length);
      EXPECT_NE(message_of<2>(file), "") << name << " cut to " << length << " bytes";
    }
  }
  const auto message = message_of<2>(fixtures / "truncated_22.msh");
  EXPECT_NE(message.find("truncated"), std::string::npos) << message;
}

TEST(Gmsh, RefusesOtherElementsThanLinearSimplices) {
  const auto message = message_of<2>(fixtures / "quadrilaterals_22.msh");
  EXPECT_NE(message.find("not a linear simplex"), std::string::npos) << message;
  EXPECT_NE(message.find("type 3"), std::string::npos) << message;
}

TEST(Gmsh, RefusesTheWrongDimension) {
  EXPECT_NE(message_of<2>(fixtures / "cube_41.msh").find("tetrahedron"), std::string::npos);
  EXPECT_NE(message_of<3>(fixtures / "rectangle_41.msh").find("no cells"), std::string::npos);
}

TEST(Gmsh, RefusesBoundariesWithoutAUniqueName) {
  const auto missing = message_of<2>(fixtures / "unnamed_side_22.msh");
  EXPECT_NE(missing.find("in no physical group"), std::string::npos) << missing;
  const auto unnamed = message_of<2>(changed("rectangle_22.msh", "4\n1 1 \"wall\"\n", "3\n"));
  EXPECT_NE(unnamed.find("has no name"), std::string::npos) << unnamed;
  const auto twice =
      message_of<2>(changed("rectangle_22.msh", "$Elements\n14\n", "$Elements\n15\n99 1 2 2 1 1 5\n"));
  EXPECT_NE(twice.find("two physical groups"), std::string::npos) << twice;
}

TEST(Gmsh, ReadsOtherUnitsOfLength) {
  const auto in_cm = import_gmsh<2>(fixtures / "rectangle_41.msh").mesh;
  const auto in_mm = import_gmsh<2>(fixtures / "rectangle_41.msh", 0.1).mesh;
  ASSERT_EQ(in_mm.points.size(), in_cm.points.size());
  for (std::size_t i = 0; i < in_mm.points.size(); ++i) EXPECT_EQ(in_mm.points[i], in_cm.points[i] * 0.1);
  EXPECT_NE(message_of<2>(changed("rectangle_22.msh", "3 2 1 0\n", "3 2e9 1 0\n")).find("too far away"),
            std::string::npos);
}

// Node 8, inside of the rectangle, is dragged: over its neighbours, then out of the rectangle.
TEST(Gmsh, RefusesCellsThatLieOverOneAnother) {
  const std::string node = "8 1.500000000002059 0.5 0";
  EXPECT_EQ(message_of<2>(changed("rectangle_22.msh", node, "8 1.6 0.55 0")), "");
  for (const auto* dragged : {"8 0.2 0.5 0", "8 1.5 1.4 0", "8 7 7 0"}) {
    const auto message = message_of<2>(changed("rectangle_22.msh", node, dragged));
    EXPECT_NE(message.find("lie over one another"), std::string::npos) << dragged << message;
    EXPECT_NE(message.find("cells in lines"), std::string::npos) << message;
  }
}

// A second rectangle, apart from the first by its nodes, lies across it or inside of it.
TEST(Gmsh, RefusesMeshesThatLieOverOneAnother) {
  const auto twice = [](double x, double y, double width, double height) {
    auto text = std::string(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 1 \"wall\"\n$EndPhysicalNames\n"
        "$Nodes\n8\n1 0 0 0\n2 4 0 0\n3 4 2 0\n4 0 2 0\n");
    const double corner[4][2] = {{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}};
    for (int i = 0; i < 4; ++i)
      text += std::to_string(5 + i) + " " + std::to_string(corner[i][0]) + " " +
              std::to_string(corner[i][1]) + " 0\n";
    text += "$EndNodes\n$Elements\n12\n";
    int element = 0;
    for (const int first : {1, 5}) {
      for (int i = 0; i < 4; ++i)
        text += std::to_string(++element) + " 1 2 1 1 " + std::to_string(first + i) + " " +
                std::to_string(first + (i + 1) % 4) + "\n";
      for (const int third : {2, 3})
        text += std::to_string(++element) + " 2 2 2 1 " + std::to_string(first) + " " +
                std::to_string(first + third - 1) + " " + std::to_string(first + third) + "\n";
    }
    const auto file = std::filesystem::path(testing::TempDir()) / "twice.msh";
    std::ofstream(file) << text + "$EndElements\n";
    return message_of<2>(file);
  };
  EXPECT_EQ(twice(5, 0, 1, 1), "");
  EXPECT_NE(twice(3, 1, 3, 3).find("crosses or touches itself"), std::string::npos);
  EXPECT_NE(twice(1, 0.5, 1, 1).find("lie over one another"), std::string::npos);
}

TEST(Gmsh, RefusesFlatCellsAndUnknownNodes) {
  const auto flat = message_of<2>(changed("rectangle_22.msh", "8 1.500000000002059 0.5 0", "8 2 0.5 0"));
  EXPECT_NE(flat.find("flat"), std::string::npos) << flat;
  const auto unknown = message_of<2>(changed("rectangle_22.msh", "7 2 2 4 1 6 4 7", "7 2 2 4 1 6 4 70"));
  EXPECT_NE(unknown.find("unknown node"), std::string::npos) << unknown;
}

} // namespace
} // namespace undula::geometry
