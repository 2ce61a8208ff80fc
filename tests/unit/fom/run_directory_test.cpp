#include "fom/run_directory.hpp"

#include <Eigen/LU>
#include <cmath>

#include "base/error.hpp"
#include "fom/scene/scene_file.hpp"
#include "io_folder.hpp"

namespace undula {
namespace {

Scene coarse_scene() {
  const std::vector<std::string> settings = {
      "mesh.gap_elements=2", "mesh.channel_size_mm=2",    "mesh.membrane_size_mm=1",
      "mesh.growth=0.6",     "time.steps_per_period=8",   "training.snapshots_per_period=8",
      "time.periods=2",      "output.checkpoint_every=4", "output.fields_every=4"};
  return read_scene(UNDULA_SOURCE_DIR "/data/scenes/wave_pump_fixed.toml", settings);
}

class RunDirectoryTest : public FolderTest {
protected:
  static void SetUpTestSuite() {
    PhaseTimer timer;
    prepared = prepare_scene(coarse_scene(), MPI_COMM_SELF, timer).release();
  }
  static void TearDownTestSuite() { delete prepared; }

  /// A state that tells its step, without a solve.
  static State made_up_state(int step) {
    State state = initial_state(prepared->disc);
    state.step = step;
    state.time = 0.001 * step;
    for (std::size_t level = 0; level < 2; ++level) {
      state.x[level].setConstant(step - static_cast<double>(level));
      state.d[level].setConstant(0.01 * std::sin(step - static_cast<double>(level)));
    }
    return state;
  }

  static void record(RunDirectory& run, int first, int last) {
    for (int step = first; step <= last; ++step) {
      const State state = made_up_state(step);
      Observation seen;
      seen.step = step;
      seen.time = state.time;
      seen.outflow = step;
      run.record(state, seen);
    }
  }

  static inline PreparedScene* prepared = nullptr;
};

TEST_F(RunDirectoryTest, GoesOnFromTheNewestCheckpointAndDropsLaterRows) {
  const Scene scene = coarse_scene();
  State state = initial_state(prepared->disc);
  {
    RunDirectory run(folder / "run", *prepared, scene, ExistingRun::refuse, 1, state);
    record(run, 1, 11); // as if killed after step 11
  }
  RunDirectory run(folder / "run", *prepared, scene, ExistingRun::go_on, 1, state);
  EXPECT_EQ(state.step, 8);
  EXPECT_EQ(state.time, 0.008);
  EXPECT_EQ(state.x[0], made_up_state(8).x[0]);
  EXPECT_EQ(state.x[1], made_up_state(8).x[1]);
  EXPECT_EQ(state.d[1], made_up_state(8).d[1]);
  EXPECT_EQ(run.series().steps.back(), 8);
  EXPECT_EQ(run.membrane().rows(), 8u);
  record(run, 9, 16);
  run.finish(made_up_state(16), PhaseTimer());
  for (const char* name : {"scene_resolved.toml", "time_series.csv", "cycle_means.csv", "envelope.csv",
                           "fluid.xdmf", "solids.xdmf", "timing.json"})
    EXPECT_TRUE(std::filesystem::exists(folder / "run" / name)) << name;
  const auto periods = summarise_periods(run.series(), 8);
  ASSERT_EQ(periods.size(), 2u);
  EXPECT_NEAR(periods[1].outflow_l_per_min, 12.5 * 0.06, 1e-12);
}

TEST_F(RunDirectoryTest, RefusesTheRunOfAnotherSceneAndLeavesItAlone) {
  Scene scene = coarse_scene();
  State state = initial_state(prepared->disc);
  { RunDirectory run(folder / "run", *prepared, scene, ExistingRun::refuse, 1, state); }
  EXPECT_THROW(check_run_directory(folder / "run", scene, ExistingRun::refuse), InputError);
  EXPECT_NO_THROW(check_run_directory(folder / "run", scene, ExistingRun::go_on));
  scene.operating_point.stroke *= 2;
  for (const auto existing : {ExistingRun::refuse, ExistingRun::go_on}) {
    try {
      RunDirectory run(folder / "run", *prepared, scene, existing, 1, state);
      FAIL() << "accepted";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("wave_pump_fixed"), std::string::npos);
    }
  }
  EXPECT_NO_THROW(check_run_directory(folder / "run", scene, ExistingRun::replace));
}

TEST_F(RunDirectoryTest, FluidPictureFillsTheFluidAndKeepsLinearFields) {
  const auto& disc = prepared->disc;
  const auto picture = fluid_picture(disc);
  double fluid = 0, drawn = 0;
  int cut_parts = 0;
  for (const auto& part : disc.cut.parts) {
    fluid += part.measure;
    cut_parts += part.cut;
  }
  ASSERT_GT(cut_parts, 0);
  for (const auto& cell : picture.mesh.cells) {
    Eigen::Matrix2d edges;
    edges << picture.mesh.points[cell[1]] - picture.mesh.points[cell[0]],
        picture.mesh.points[cell[2]] - picture.mesh.points[cell[0]];
    drawn += std::abs(edges.determinant()) / 2;
  }
  EXPECT_NEAR(drawn, fluid, 1e-12 * fluid);

  State state = initial_state(disc);
  const auto linear = [](const Point<2>& x) { return Eigen::Vector3d(2 * x[0] - x[1], x[1] + 1, 3 - x[0]); };
  for (std::size_t node = 0; node < disc.fluid_nodes.dof_point.size(); ++node)
    state.x[0].segment<3>(disc.velocity_unknown(static_cast<int>(node), 0)) =
        linear(disc.cut.mesh.points[disc.fluid_nodes.dof_point[node]]);
  const auto fields = fluid_fields(disc, picture, state);
  for (std::size_t p = 0; p < picture.mesh.points.size(); ++p) {
    const auto expected = linear(picture.mesh.points[p]);
    EXPECT_NEAR(fields[0].values[2 * p], expected[0], 1e-10);
    EXPECT_NEAR(fields[0].values[2 * p + 1], expected[1], 1e-10);
    EXPECT_NEAR(fields[1].values[p], expected[2], 1e-10);
  }
}

TEST(StepTable, EnergyGapIsWhatTheTermsLeaveOver) {
  // Holder 3 W, opening -1 W, losses 0.6 + 0.3 + 0.1 W, and 0.9 W go into stored energy: 0.1 W of 3 W are
  // missing.
  TimeSeries table{observation_columns(), {}, {}};
  for (int step = 1; step <= 8; ++step) {
    Observation seen;
    seen.step = step;
    seen.time = 0.01 * step;
    seen.energy.holder = 3e7;
    seen.energy.opening = -1e7;
    seen.energy.viscous = 0.6e7;
    seen.energy.stabilisation = 0.3e7;
    seen.energy.damping = 0.1e7;
    seen.energy.kinetic = 0.5e7 * seen.time;
    seen.energy.elastic = 0.4e7 * seen.time;
    table.steps.push_back(step);
    const auto row = observation_row(seen);
    table.values.insert(table.values.end(), row.begin(), row.end());
  }
  for (const auto& period : summarise_periods(table, 4)) {
    EXPECT_NEAR(period.input_power_mW, 3000, 1e-9);
    EXPECT_NEAR(period.energy_gap, 0.1 / 3, 1e-12) << period.period;
  }
}

TEST(RunDirectoryChecks, CheckpointsHaveToFallOnFreshFactorisations) {
  Scene scene;
  scene.time.factor_every = 4;
  for (const int good : {0, 4, 8}) {
    scene.output.checkpoint_every = good;
    EXPECT_NO_THROW(check_checkpoint_interval(scene));
  }
  scene.output.checkpoint_every = 6;
  EXPECT_THROW(check_checkpoint_interval(scene), InputError);
}

} // namespace
} // namespace undula
