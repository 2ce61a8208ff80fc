#include "training/reduction/drawn_bases.hpp"

#include <gtest/gtest.h>

#include <random>

#include "coarse_pump.hpp"
#include "fom/output/level_view.hpp"
#include "fom/output/visual_mesh.hpp"
#include "training/campaign/recorded_run.hpp"

namespace undula::training {
namespace {

TEST(DrawnBases, SumsOfDrawnModesAreTheFieldsThatAStateWrites) {
  // 1. Any modes, each on the unknowns of its field, and any amplitudes.
  PhaseTimer timer;
  const auto prepared = prepare_scene(coarse_pump(), MPI_COMM_SELF, timer);
  const auto& disc = prepared->disc;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto columns = [&](const std::vector<int>& unknowns, int count) {
    Eigen::MatrixXd modes = Eigen::MatrixXd::Zero(disc.unknowns(), count);
    for (int j = 0; j < count; ++j)
      for (const int unknown : unknowns) modes(unknown, j) = normal(random);
    return modes;
  };
  Bases bases;
  bases.velocity = columns(velocity_unknowns(disc), 3);
  bases.pressure = columns(pressure_unknowns(disc), 2);
  bases.displacement = columns(displacement_unknowns(disc), 2);
  const auto drawn = drawn_bases(disc, bases);
  const Eigen::VectorXd a = Eigen::VectorXd::LinSpaced(3, 1, 2), p = Eigen::VectorXd::LinSpaced(2, -1, 3),
                        d = Eigen::VectorXd::LinSpaced(2, 0.5, -2);
  const double holder = 0.04;

  // 2. The state that they stand for, drawn as a run draws it.
  State state;
  state.x[0] = bases.velocity * a + bases.pressure * p;
  state.d[0] = bases.displacement * d + holder * imposed_lifting(disc);
  const auto picture = fluid_picture(disc);
  const auto fluid = fluid_fields(disc, picture, state), solids = solid_fields(disc, state);
  const auto expect_same = [](const Eigen::VectorXd& sum, const std::vector<double>& values) {
    ASSERT_EQ(static_cast<std::size_t>(sum.size()), values.size());
    const auto stored = Eigen::Map<const Eigen::VectorXd>(values.data(), sum.size());
    EXPECT_GT(stored.norm(), 0);
    EXPECT_LT((sum - stored).norm(), 1e-12 * stored.norm());
  };
  expect_same(drawn.velocity * a, field_named(fluid, "velocity").values);
  expect_same(drawn.pressure * p, field_named(fluid, "pressure").values);
  expect_same(drawn.displacement * d + drawn.holder * holder, field_named(solids, "displacement").values);

  // 3. On its meshes; the holder moves every point of the solids alike, along the axis.
  ASSERT_EQ(static_cast<std::size_t>(drawn.fluid.points.rows()), picture.mesh.points.size());
  EXPECT_EQ(drawn.fluid.points.row(7), picture.mesh.points[7].transpose());
  EXPECT_EQ(drawn.fluid.cells(5, 2), picture.mesh.cells[5][2]);
  for (Eigen::Index i = 0; i < drawn.solids.points.rows(); ++i) {
    EXPECT_EQ(drawn.holder[2 * i], 0);
    EXPECT_EQ(drawn.holder[2 * i + 1], 1);
  }
}

} // namespace
} // namespace undula::training
