// From runs on a moving domain to a reduced model and back, on a coarse pump.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "fom/levels/moving_reduced_level.hpp"
#include "fom/scene/scene_file.hpp"
#include "rom/base/error.hpp"
#include "rom/base/units.hpp"
#include "training/campaign/campaign.hpp"
#include "training/campaign/recorded_level.hpp"
#include "training/emulation/fit_responses.hpp"
#include "training/moving_domain/build_moving_model.hpp"
#include "training/sampling/trainable_scene.hpp"

namespace undula::training {
namespace {

/// The pump at a tenth of its voltage, whose films stay open.
Scene coarse_scene(std::vector<std::string> overrides = {}) {
  std::vector<std::string> all = {"space.order=1",
                                  "mesh.gap_elements=2",
                                  "mesh.channel_size_mm=1.5",
                                  "mesh.growth=1",
                                  "time.steps_per_period=24",
                                  "time.periods=2",
                                  "training.model=projected",
                                  "training.snapshots_per_period=24",
                                  "training.voltage_low_V=4",
                                  "training.voltage_high_V=4",
                                  "training.head_low_mmHg=5",
                                  "training.head_high_mmHg=5",
                                  "training.training_points=0",
                                  "training.held_out_points=0",
                                  "training.velocity_modes=20",
                                  "training.displacement_modes=6",
                                  "training.pressure_modes=12"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  return read_scene(UNDULA_SOURCE_DIR "/data/scenes/wave_pump_mapped_voltage.toml", all);
}

class MovingModel : public testing::Test {
protected:
  static void SetUpTestSuite() {
    folder = std::filesystem::temp_directory_path() / ("undula_moving_model_" + std::to_string(::getpid()));
    scene = coarse_scene();
    store = std::make_unique<CampaignStore>(folder, stamp_campaign(scene));
    plan = plan_samples(scene.training, scene.operating_point);
    run_campaign(scene, plan.training, *store, MPI_COMM_SELF, {});
  }
  static void TearDownTestSuite() {
    store.reset();
    std::filesystem::remove_all(folder);
  }
  static inline std::filesystem::path folder;
  static inline Scene scene;
  static inline SamplingPlan plan;
  static inline std::unique_ptr<CampaignStore> store;
};

TEST_F(MovingModel, MarchesAsTheRunItWasMadeFrom) {
  ASSERT_EQ(plan.training.size(), 1U);
  PhaseTimer timer;
  const auto built = build_moving_model(scene, plan, *store, timer);
  EXPECT_EQ(built.bases.velocity, 20);
  EXPECT_EQ(built.bases.pressure, 13); // the constant is one more
  EXPECT_EQ(built.bases.supremizers, 13);
  EXPECT_GT(built.bases.lifted, 0);
  EXPECT_TRUE(std::isinf(built.model.error_l_per_min)); // nothing was held out
  const auto& run = built.model.runs.front();

  MovingReducedLevel level(built.model, "model", MPI_COMM_SELF, timer);
  const double head = run.head_mmHg;
  const Scene asked = scene_of_moving_model(built.model, "model", run.frequency_Hz, {{}, run.voltage_V});
  const auto point = level.curve(asked, std::span(&head, 1)).front();
  EXPECT_NEAR(point.stroke_mm, run.stroke_mm, 0.02 * run.stroke_mm);
  EXPECT_NEAR(point.flow_l_per_min, run.flow_l_per_min, 0.05 * std::abs(run.flow_l_per_min));
  EXPECT_NEAR(point.inflow_l_per_min, point.flow_l_per_min, 0.3 * std::abs(run.flow_l_per_min));
  EXPECT_TRUE(point.inside_training_box.value());

  // Elsewhere it says that it does not know.
  const double other = head + 5;
  EXPECT_EQ(level.remarks(asked, std::span(&other, 1)).size(), 1U);
  EXPECT_TRUE(std::isinf(level.curve(asked, std::span(&other, 1)).front().error_l_per_min));
  EXPECT_THROW(scene_of_moving_model(built.model, "model", 120, {}), InputError);
}

// The membrane's outermost probe moves with the holder, the flow's mean over the phases is that of the
// period.
TEST_F(MovingModel, TheRecordedCourseOverAPeriodIsThatOfTheRun) {
  PhaseTimer timer;
  const auto prepared = prepare_scene(scene, MPI_COMM_SELF, timer);
  const auto record = store->load(plan.training.front());
  const auto quantities = recorded_quantities(*prepared, scene);
  const auto values = recorded_values(*prepared, scene, record);
  ASSERT_EQ(values.size(), 2U);
  const auto places = static_cast<Eigen::Index>(quantities[0].places_mm.size());
  ASSERT_EQ(values[0].size(), places * 12);
  ASSERT_EQ(values[1].size(), 12);
  const auto last = [&](const std::string& column, const std::vector<double>& of) {
    const auto& columns = record.cycles.columns;
    const auto at = std::ranges::find(columns, column) - columns.begin();
    return of[of.size() - columns.size() + static_cast<std::size_t>(at)];
  };
  const double mean = last("outflow_l_per_min", record.cycles.mean);
  const double swing =
      last("outflow_l_per_min", record.cycles.maximum) - last("outflow_l_per_min", record.cycles.minimum);
  EXPECT_NEAR(values[1].mean(), mean, 0.02 * swing);
  EXPECT_GT(values[1].maxCoeff() - values[1].minCoeff(), 0.8 * swing);
  double outermost = 0;
  for (Eigen::Index k = 0; k < 12; ++k)
    outermost = std::max(outermost, std::abs(values[0][k * places + places - 1]));
  const double stroke = curve_point_of(scene, record).stroke_mm;
  EXPECT_NEAR(outermost, stroke, 0.15 * stroke); // the phases miss the peak, and there is an offset
}

TEST_F(MovingModel, IsRefusedOnAnotherMesh) {
  PhaseTimer timer;
  auto built = build_moving_model(scene, plan, *store, timer);
  built.model.basis.conservativeResize(built.model.basis.rows() - 3, Eigen::NoChange);
  EXPECT_THROW(reduced_march(built.model, "model", MPI_COMM_SELF, timer), InputError);
}

// The weighted sum of a few parts against the sum of all, by operators that the cubature does not use.
TEST_F(MovingModel, CubatureMeetsTheForcesOfASnapshot) {
  PhaseTimer timer;
  const auto prepared = prepare_scene(scene, MPI_COMM_SELF, timer);
  const std::vector<RunRecord> runs{store->load(plan.training.front())};
  const auto bases = build_moving_bases(*prepared, scene, runs);
  constexpr double tolerance = 0.01;
  const auto cubature = choose_cubature(*prepared, scene, bases.basis, bases.pressure, runs, tolerance);
  EXPECT_LE(cubature.part_error, tolerance);
  EXPECT_LE(cubature.cell_error, tolerance);
  EXPECT_LT(cubature.parts, static_cast<int>(cubature.part_weights.size()));
  EXPECT_LT(cubature.cells, static_cast<int>(cubature.cell_weights.size()));
  for (const double weight : cubature.part_weights) EXPECT_GE(weight, 0);

  auto& disc = prepared->disc;
  const Eigen::Index snapshot = 23;
  const double step = 1 / (scene.operating_point.frequency * scene.time.steps_per_period);
  disc.map = map_at(runs.front(), snapshot, step);
  const Eigen::VectorXd x = unknowns_at(disc, runs.front(), snapshot);
  const auto forces = [&](std::shared_ptr<const ReducedSpace> space) {
    disc.reduced = std::move(space);
    auto operators = build_operators(disc, MPI_COMM_SELF, timer);
    operators.solid_mass.clear();
    move_operators(disc, operators, timer);
    return Eigen::VectorXd(bases.basis.transpose() * (operators.physical * x + operators.mass * x / step));
  };
  const Eigen::VectorXd all = forces(nullptr);
  auto weighted = std::make_shared<ReducedSpace>();
  weighted->part_weights = cubature.part_weights;
  const Eigen::VectorXd few = forces(weighted);
  EXPECT_LT((few - all).norm(), 0.1 * all.norm());
  for (double& weight : weighted->part_weights) weight = weight > 0 ? 1 : 0;
  EXPECT_GT((forces(weighted) - all).norm(), 0.3 * all.norm()); // it is the weights that do it
}

TEST_F(MovingModel, RecordedRunsAnswerWithoutBeingRunAgain) {
  RecordedLevel level(scene, *store, MPI_COMM_SELF);
  const double head = units::pressure_to_mmHg(plan.training.front().head);
  Scene asked = scene;
  asked.operating_point = plan.training.front();
  const auto point = level.curve(asked, std::span(&head, 1)).front();
  EXPECT_EQ(level.runs(), 0);
  EXPECT_TRUE(std::isfinite(point.flow_l_per_min));
  std::vector<std::string> damaged;
  EXPECT_EQ(store->recorded_points(damaged).size(), 1U);
  EXPECT_TRUE(damaged.empty());
}

TEST(MovingModelScenes, WhatCannotBeProjectedIsRefused) {
  EXPECT_NO_THROW(require_trainable(coarse_scene()));
  EXPECT_THROW(require_trainable(coarse_scene({"time.scheme=bdf1"})), InputError);
  EXPECT_THROW(require_trainable(coarse_scene({"training.snapshots_per_period=12"})), InputError);
}

} // namespace
} // namespace undula::training
