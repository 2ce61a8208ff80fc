// Pumps from imported meshes and from profiles: units, axis, order of the meshes, the clamp, materials.
#include "fom/machines/wave_pump/pump_checks.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "fom/machines/wave_pump/pump_problem.hpp"
#include "fom/scene/scene_file.hpp"
#include "geometry/mesh/mesh_quality.hpp"
#include "io_folder.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"

namespace undula::fom {
namespace {

/// A Gmsh file of a rectangle of `columns` x 6 squares, each in two; `names`: of its lower, right, upper and
/// left side.
void write_box(const std::filesystem::path& file, Point<2> low, Point<2> high, int columns,
               const std::array<std::string, 4>& names, double unit = 1) {
  const int rows = 6;
  const auto node = [&](int i, int j) { return j * (columns + 1) + i + 1; };
  std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n";
  for (int k = 0; k < 4; ++k) text += "1 " + std::to_string(k + 1) + " \"" + names[k] + "\"\n";
  text += "$EndPhysicalNames\n$Nodes\n" + std::to_string((columns + 1) * (rows + 1)) + "\n";
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i)
      text += std::to_string(node(i, j)) + " " +
              exact_number((low[0] + (high[0] - low[0]) * i / columns) * unit) + " " +
              exact_number((low[1] + (high[1] - low[1]) * j / rows) * unit) + " 0\n";
  std::vector<std::string> elements;
  const auto side = [&](int tag, int a, int b) {
    elements.push_back("1 2 " + std::to_string(tag) + " " + std::to_string(tag) + " " + std::to_string(a) +
                       " " + std::to_string(b));
  };
  for (int i = 0; i < columns; ++i) {
    side(1, node(i, 0), node(i + 1, 0));
    side(3, node(i, rows), node(i + 1, rows));
  }
  for (int j = 0; j < rows; ++j) {
    side(2, node(columns, j), node(columns, j + 1));
    side(4, node(0, j), node(0, j + 1));
  }
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      for (const int third : {node(i + 1, j + 1), node(i, j + 1)})
        elements.push_back("2 2 9 9 " + std::to_string(node(i, j)) + " " +
                           std::to_string(third == node(i, j + 1) ? node(i + 1, j + 1) : node(i + 1, j)) +
                           " " + std::to_string(third));
  text += "$EndNodes\n$Elements\n" + std::to_string(elements.size()) + "\n";
  for (std::size_t e = 0; e < elements.size(); ++e) text += std::to_string(e + 1) + " " + elements[e] + "\n";
  std::ofstream(file) << text + "$EndElements\n";
}

class ImportedPump : public FolderTest {
protected:
  void SetUp() override {
    FolderTest::SetUp();
    write_box(folder / "fluid.msh", {0, 0}, {2, 2}, 12, {"outlet", "shell", "inlet", "axis"});
    write_box(folder / "leaf.msh", {0.5, 0.9}, {1.6, 1.1}, 8, skin);
    write_box(folder / "magnet.msh", {1.7, 0.9}, {1.9, 1.1}, 3, skin);
  }

  Scene scene(const std::vector<std::string>& settings = {}) const {
    return parse_scene(R"toml(
name = "imported"
[geometry]
fluid_mesh = "fluid.msh"
solid_meshes = ["leaf.msh", "magnet.msh"]
[fluid]
density_g_per_cm3 = 1.0
viscosity_poise = 0.035
[membrane]
density_g_per_cm3 = 1.1
young_dyn_per_cm2 = 1e7
poisson = 0.4
damping_time_s = 1e-4
clamp_radius_mm = 13.0
[operating_point]
frequency_Hz = 120.0
stroke_mm = 0.1
head_mmHg = 5.0
[mesh]
channel_size_mm = 0.8
membrane_size_mm = 0.4
)toml",
                       "imported", folder, settings);
  }

  std::string message_of(const std::vector<std::string>& settings = {}) const {
    try {
      pump_problem(scene(settings));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  void expect_refused(const std::string& what, const std::vector<std::string>& settings = {}) const {
    const std::string message = message_of(settings);
    EXPECT_NE(message.find(what), std::string::npos) << what << "\nin: " << message;
  }

  const std::array<std::string, 4> skin = {"skin", "skin", "skin", "skin"};
};

TEST_F(ImportedPump, IsRead) {
  EXPECT_EQ(message_of(), "");
  const auto problem = pump_problem(scene());
  ASSERT_EQ(problem.solids.size(), 2u);
  EXPECT_EQ(problem.solids[0].name, "membrane");
  EXPECT_FALSE(problem.solids[0].imposed({1.2, 1.0}));
  EXPECT_TRUE(problem.solids[0].imposed({1.4, 1.0}));
  EXPECT_TRUE(problem.solids[1].imposed({1.4, 1.0}));
}

TEST_F(ImportedPump, TheUnitOfTheMeshesIsThatOfTheScene) {
  const double area = mesh_quality(pump_problem(scene()).background).area;
  write_box(folder / "fluid.msh", {0, 0}, {2, 2}, 12, {"outlet", "shell", "inlet", "axis"}, 10);
  write_box(folder / "leaf.msh", {0.5, 0.9}, {1.6, 1.1}, 8, skin, 10);
  write_box(folder / "magnet.msh", {1.7, 0.9}, {1.9, 1.1}, 3, skin, 10);
  EXPECT_NEAR(mesh_quality(pump_problem(scene({"geometry.mesh_unit=mm"})).background).area, area, 1e-12);
  // In mm, read as cm: all of the membrane lies beyond the clamp radius.
  expect_refused("\"geometry.mesh_unit\"");
}

TEST_F(ImportedPump, MeshesOfDifferentUnitsDoNotMeet) {
  write_box(folder / "leaf.msh", {0.5, 0.9}, {1.6, 1.1}, 8, skin, 10);
  expect_refused("a body lies outside of the fluid");
}

TEST_F(ImportedPump, TheFirstMeshIsTheMembrane) {
  expect_refused("mesh magnet.msh, has r from 17 to 19 mm",
                 {"geometry.solid_meshes=[\"" + (folder / "magnet.msh").string() + "\", \"" +
                  (folder / "leaf.msh").string() + "\"]"});
  EXPECT_THROW(scene({"geometry.solid_meshes=[]"}), InputError);
  expect_refused("the membrane floats", {"membrane.clamp_radius_mm=16.5"});
}

TEST_F(ImportedPump, TheAxisIsNamedAndNothingElseIs) {
  write_box(folder / "fluid.msh", {0, 0}, {2, 2}, 12, {"outlet", "shell", "inlet", "Axis"});
  expect_refused("a boundary on the axis of symmetry would be a wall");
  write_box(folder / "fluid.msh", {0, 0}, {2, 2}, 12, {"outlet", "axis", "inlet", "axis"});
  expect_refused("a boundary named \"axis\" is not on the axis");
  write_box(folder / "fluid.msh", {0.2, 0}, {2, 2}, 12, {"outlet", "shell", "inlet", "axis"});
  expect_refused("a boundary named \"axis\" is not on the axis");
  write_box(folder / "fluid.msh", {0.2, 0}, {2, 2}, 12, {"outlet", "shell", "inlet", "core"}); // a ring
  EXPECT_EQ(message_of(), "");
}

TEST_F(ImportedPump, RadiiAreNotNegative) {
  write_box(folder / "fluid.msh", {-2, 0}, {0, 2}, 12, {"outlet", "axis", "inlet", "shell"});
  expect_refused("a mesh has negative radii");
}

TEST_F(ImportedPump, SolidsStayApartAndLeaveTheOpeningsFree) {
  write_box(folder / "magnet.msh", {1.5, 0.9}, {1.9, 1.1}, 3, skin);
  expect_refused("two bodies lie over one another");
  write_box(folder / "magnet.msh", {-0.0, -0.1}, {2.1, 0.5}, 3, skin);
  expect_refused("bodies cover a boundary that fluid is to flow through");
}

TEST_F(ImportedPump, TheOpeningsAreNamed) {
  write_box(folder / "fluid.msh", {0, 0}, {2, 2}, 12, {"Outlet", "shell", "inlet", "axis"});
  expect_refused("no boundary named 'outlet'; there are \"Outlet\", \"axis\", \"inlet\", \"shell\"");
}

const std::string fixed = UNDULA_SOURCE_DIR "/data/scenes/wave_pump_fixed.toml";

TEST(PumpChecks, TheMeshKeepsALineWhereTheMotionIsImposed) {
  const std::vector<std::string> settings = {"mesh.gap_elements=2", "mesh.channel_size_mm=2.5",
                                             "mesh.membrane_size_mm=0.8", "membrane.clamp_radius_mm=15.0"};
  const auto membrane = pump_problem(read_scene(fixed, settings)).solids[0].mesh;
  int on_line = 0;
  for (const auto& x : membrane.points) on_line += std::abs(x[0] - 1.5) < 1e-12 ? 1 : 0;
  EXPECT_GE(on_line, 3);
}

TEST(PumpChecks, EstimatesTheCellsOfTheMeshes) {
  for (const char* size : {"0.8", "2.0"}) {
    const Scene scene =
        read_scene(fixed, std::vector<std::string>{std::string("mesh.channel_size_mm=") + size,
                                                   "mesh.gap_elements=3", "mesh.membrane_size_mm=0.6"});
    const PumpWork work = check_pump_work(scene, scene_profile(scene));
    const auto problem = pump_problem(scene);
    EXPECT_NEAR(work.fluid_cells / mesh_quality(problem.background).cells, 1, 0.4);
    const int solids =
        mesh_quality(problem.solids[0].mesh).cells + mesh_quality(problem.solids[1].mesh).cells;
    EXPECT_NEAR(work.solid_cells / solids, 1, 0.5);
  }
}

class ProfileMaterials : public FolderTest {};

TEST_F(ProfileMaterials, AreComparedWithThoseOfTheScene) {
  Scene scene = read_scene(fixed);
  EXPECT_TRUE(profile_differences(scene).empty());
  std::string text = read_text_file(scene.profile);
  const std::string young = "young = 1.686e7";
  text.replace(text.find(young), young.size(), "young = 1.0");
  std::ofstream(folder / "profile.toml") << text;
  scene.profile = folder / "profile.toml";
  const auto sentences = profile_differences(scene);
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_NE(sentences[0].find(
                "materials.membrane.young = 1; what counts is membrane.young_dyn_per_cm2 = 1.686e+07"),
            std::string::npos)
      << sentences[0];
}

} // namespace
} // namespace undula::fom
