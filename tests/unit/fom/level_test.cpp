// What a level shows of itself. Finite elements on the coarsest mesh of the pump.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "fom/levels/finite_element_level.hpp"
#include "fom/output/visual_mesh.hpp"
#include "fom/scene/scene_file.hpp"
#include "rom/base/error.hpp"

namespace undula::fom {
namespace {

Scene coarse_scene() {
  const std::vector<std::string> settings = {"mesh.gap_elements=2", "mesh.channel_size_mm=2",
                                             "mesh.membrane_size_mm=1", "mesh.growth=0.6"};
  return read_scene(UNDULA_SOURCE_DIR "/data/scenes/wave_pump_fixed.toml", settings);
}

TEST(FluidPicture, FillsTheFluidAndKeepsLinearFields) {
  PhaseTimer timer;
  const FiniteElementLevel level(coarse_scene(), MPI_COMM_SELF, timer);
  const auto& disc = level.prepared().disc;
  const LevelView view = level.view(coarse_scene());
  const auto& mesh = view.fluid;
  double fluid = 0, drawn = 0;
  int cut_parts = 0;
  for (const auto& part : disc.cut.parts) {
    fluid += part.measure;
    cut_parts += part.cut;
  }
  ASSERT_GT(cut_parts, 0);
  for (const auto& cell : mesh.cells) {
    Eigen::Matrix2d edges;
    edges << mesh.points[cell[1]] - mesh.points[cell[0]], mesh.points[cell[2]] - mesh.points[cell[0]];
    drawn += std::abs(edges.determinant()) / 2;
  }
  EXPECT_NEAR(drawn, fluid, 1e-12 * fluid);
  for (const auto& cell : mesh.cells)
    EXPECT_FALSE(is_flat<2>({mesh.points[cell[0]], mesh.points[cell[1]], mesh.points[cell[2]]}));

  State state = level.initial_state();
  const auto linear = [](const Point<2>& x) { return Eigen::Vector3d(2 * x[0] - x[1], x[1] + 1, 3 - x[0]); };
  for (std::size_t node = 0; node < disc.fluid_nodes.dof_point.size(); ++node)
    state.x[0].segment<3>(disc.velocity_unknown(static_cast<int>(node), 0)) =
        linear(disc.cut.mesh.points[disc.fluid_nodes.dof_point[node]]);
  const auto fields = view.fluid_fields(state);
  for (std::size_t p = 0; p < mesh.points.size(); ++p) {
    const auto expected = linear(mesh.points[p]);
    EXPECT_NEAR(fields[0].values[2 * p], expected[0], 1e-10);
    EXPECT_NEAR(fields[0].values[2 * p + 1], expected[1], 1e-10);
    EXPECT_NEAR(fields[1].values[p], expected[2], 1e-10);
  }
}

TEST(FluidPicture, ATriangleIsFlatWhereItsAreaIsNothingBesideItsLength) {
  EXPECT_FALSE(is_flat<2>({Point<2>(0, 0), Point<2>(1, 0), Point<2>(0.5, 1e-6)}));
  EXPECT_TRUE(is_flat<2>({Point<2>(0, 0), Point<2>(1, 0), Point<2>(0.5, 1e-12)}));
  EXPECT_TRUE(is_flat<2>({Point<2>(1, 1), Point<2>(1, 1), Point<2>(2, 1)}));
  EXPECT_FALSE(is_flat<2>({Point<2>(0, 0), Point<2>(1e-8, 0), Point<2>(0, 1e-8)})); // small is not flat
}

TEST(LevelView, BoundaryEdgesAreThoseOfOneTriangle) {
  const FieldMesh<2> square = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 1, 2}, {0, 2, 3}}};
  const std::vector<std::array<int, 2>> expected = {{0, 1}, {0, 3}, {1, 2}, {2, 3}};
  EXPECT_EQ(boundary_edges(square), expected);
}

TEST(LevelView, AFieldThatIsNotThereIsNamed) {
  const std::vector<NodalField> fields = {{"velocity", "cm/s", 2, {}}, {"pressure", "dyn/cm^2", 1, {}}};
  EXPECT_EQ(&field_named(fields, "pressure"), &fields[1]);
  try {
    field_named(fields, "presure");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("velocity, pressure"), std::string::npos);
  }
}

} // namespace
} // namespace undula::fom
