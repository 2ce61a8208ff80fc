#include "fom/output/run_directory.hpp"

#include <cmath>

#include "fom/scene/scene_file.hpp"
#include "io_folder.hpp"
#include "rom/base/error.hpp"
#include "rom/base/hdf5_file.hpp"
#include "rom/base/text_file.hpp"

namespace undula::fom {
namespace {

/// The scene only lends its hash, its name and its intervals: the level below knows nothing of it.
Scene two_periods() {
  const std::vector<std::string> settings = {"time.steps_per_period=8", "training.snapshots_per_period=8",
                                             "time.periods=2", "output.checkpoint_every=4",
                                             "output.fields_every=4"};
  return read_scene(UNDULA_SOURCE_DIR "/data/scenes/wave_pump_fixed.toml", settings);
}

constexpr int unknowns = 5, displacements = 3, probes = 2;

/// A level of one triangle of fluid and one of solid. It has another number of displacements than of other
/// unknowns.
LevelView one_triangle() {
  LevelView view;
  view.probes.radius = {0.1, 0.2};
  view.probes.axial.resize(probes, displacements);
  view.probes.axial.insert(0, 0) = 1;
  view.probes.axial.insert(1, 2) = 2;
  view.fluid = {{{0, 0}, {1, 0}, {0, 1}}, {{0, 1, 2}}};
  view.solids = view.fluid;
  view.fluid_fields = [](const State& state) {
    return std::vector<NodalField>{
        {"pressure", "dyn/cm^2", 1, {state.x[0][0], state.x[0][1], state.x[0][2]}}};
  };
  view.solid_fields = [](const State& state) {
    return std::vector<NodalField>{{"displacement", "cm", 1, {state.d[0][0], state.d[0][1], state.d[0][2]}}};
  };
  return view;
}

State at_rest() {
  State state;
  for (std::size_t level = 0; level < 2; ++level) {
    state.x[level] = Eigen::VectorXd::Zero(unknowns);
    state.d[level] = Eigen::VectorXd::Zero(displacements);
  }
  return state;
}

class RunDirectoryTest : public FolderTest {
protected:
  /// A state that tells its step, without a solve.
  static State made_up_state(int step) {
    State state = at_rest();
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
};

TEST_F(RunDirectoryTest, GoesOnFromTheNewestCheckpointAndDropsLaterRows) {
  const Scene scene = two_periods();
  State state = at_rest();
  {
    RunDirectory run(folder / "run", one_triangle(), scene, ExistingRun::refuse, 1, state);
    record(run, 1, 11); // as if killed after step 11
  }
  RunDirectory run(folder / "run", one_triangle(), scene, ExistingRun::go_on, 1, state);
  EXPECT_EQ(state.step, 8);
  EXPECT_EQ(state.time, 0.008);
  EXPECT_EQ(state.x[0], made_up_state(8).x[0]);
  EXPECT_EQ(state.x[1], made_up_state(8).x[1]);
  EXPECT_EQ(state.d[1], made_up_state(8).d[1]);
  EXPECT_EQ(run.series().steps.back(), 8);
  ASSERT_EQ(run.membrane().rows(), 8u);
  EXPECT_NEAR(run.membrane().value(7, 0), 0.1 * std::sin(8.0), 1e-15); // cm -> mm
  EXPECT_NEAR(run.membrane().value(7, 1), 0.2 * std::sin(8.0), 1e-15);
  record(run, 9, 16);
  run.finish(made_up_state(16), PhaseTimer());
  for (const char* name : {"scene_resolved.toml", "time_series.csv", "cycle_means.csv", "envelope.csv",
                           "fluid.xdmf", "solids.xdmf", "timing.json"})
    EXPECT_TRUE(std::filesystem::exists(folder / "run" / name)) << name;
  const auto periods = summarise_periods(run.series(), 8);
  ASSERT_EQ(periods.size(), 2u);
  EXPECT_NEAR(periods[1].outflow_l_per_min, 12.5 * 0.06, 1e-12);
}

TEST_F(RunDirectoryTest, FieldsAreThoseOfTheLevelAndStopWhereTheRunDoes) {
  const Scene scene = two_periods();
  State state = at_rest();
  {
    RunDirectory run(folder / "run", one_triangle(), scene, ExistingRun::refuse, 1, state);
    record(run, 1, 11);
  }
  RunDirectory run(folder / "run", one_triangle(), scene, ExistingRun::go_on, 1, state);
  record(run, 9, 16);
  const std::string index = read_text_file(folder / "run" / "fluid.xdmf");
  std::size_t times = 0;
  for (auto at = index.find("<Time "); at != std::string::npos; at = index.find("<Time ", at + 1)) ++times;
  EXPECT_EQ(times, 4u); // steps 4, 8, 12, 16, none twice
  const auto file = Hdf5File::open_read(folder / "run" / "fluid_12.h5");
  EXPECT_EQ(file.read<double>("fields/pressure"), std::vector<double>(3, 12.0));
}

TEST_F(RunDirectoryTest, AStateOfAnotherSizeIsRefused) {
  const Scene scene = two_periods();
  State state = at_rest();
  {
    RunDirectory run(folder / "run", one_triangle(), scene, ExistingRun::refuse, 1, state);
    record(run, 1, 4);
  }
  State other = at_rest();
  other.d[1] = Eigen::VectorXd::Zero(unknowns);
  EXPECT_THROW(RunDirectory(folder / "run", one_triangle(), scene, ExistingRun::go_on, 1, other), InputError);
}

TEST_F(RunDirectoryTest, RefusesTheRunOfAnotherSceneAndLeavesItAlone) {
  Scene scene = two_periods();
  State state = at_rest();
  { RunDirectory run(folder / "run", one_triangle(), scene, ExistingRun::refuse, 1, state); }
  EXPECT_THROW(check_run_directory(folder / "run", scene, ExistingRun::refuse), InputError);
  EXPECT_NO_THROW(check_run_directory(folder / "run", scene, ExistingRun::go_on));
  scene.operating_point.stroke *= 2;
  for (const auto existing : {ExistingRun::refuse, ExistingRun::go_on}) {
    try {
      RunDirectory run(folder / "run", one_triangle(), scene, existing, 1, state);
      FAIL() << "accepted";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("wave_pump_fixed"), std::string::npos);
    }
  }
  EXPECT_NO_THROW(check_run_directory(folder / "run", scene, ExistingRun::replace));
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
} // namespace undula::fom
