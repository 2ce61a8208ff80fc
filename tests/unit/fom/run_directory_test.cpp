#include "fom/output/run_directory.hpp"

#include <cmath>
#include <fstream>
#include <functional>
#include <set>

#include "fom/scene/scene_file.hpp"
#include "io_folder.hpp"
#include "rom/base/error.hpp"
#include "rom/base/file_format.hpp"
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

TEST_F(RunDirectoryTest, TheKeyThatDiffersIsNamed) {
  const Scene scene = two_periods();
  State state = at_rest();
  { RunDirectory run(folder / "run", one_triangle(), scene, ExistingRun::refuse, 1, state); }
  Scene other = scene;
  other.fluid.viscosity *= 2;
  other.output.fields_every = 8; // does not shape the state
  try {
    check_run_directory(folder / "run", other, ExistingRun::go_on);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("fluid.viscosity_poise: was "), std::string::npos) << message;
    EXPECT_EQ(message.find("fields_every"), std::string::npos) << message;
  }
}

TEST_F(RunDirectoryTest, FilesThatNoRunWroteAreRefused) {
  const Scene scene = two_periods();
  for (const char* name :
       {"time_series.csv", "fluid_3.h5", "flow.png", "checkpoints/checkpoint_4.h5", "campaign.h5"}) {
    const auto run = folder / "theirs";
    std::filesystem::create_directories((run / name).parent_path());
    std::ofstream(run / name) << "mine";
    for (const auto existing : {ExistingRun::refuse, ExistingRun::go_on, ExistingRun::replace})
      EXPECT_THROW(check_run_directory(run, scene, existing), InputError) << name;
    EXPECT_EQ(read_text_file(run / name), "mine");
    std::filesystem::remove_all(run);
  }
  std::filesystem::create_directories(folder / "theirs" / "checkpoints");
  std::ofstream(folder / "theirs" / "checkpoints" / "other_solver.h5") << "mine";
  std::ofstream(folder / "theirs" / "scene.toml") << "mine";
  EXPECT_NO_THROW(check_run_directory(folder / "theirs", scene, ExistingRun::refuse));
}

TEST_F(RunDirectoryTest, ReplacingTakesEveryFileOfTheRunAndNoOther) {
  const Scene scene = two_periods();
  State state = at_rest();
  {
    RunDirectory run(folder / "run", one_triangle(), scene, ExistingRun::refuse, 1, state);
    record(run, 1, 8);
    run.finish(made_up_state(8), PhaseTimer());
  }
  for (const char* name :
       {"speed.png", "flow.gp", "notes.txt", "speed_of_my_own.png", "time_series.csv.4711.0.partial",
        "checkpoints/checkpoint_12.h5.4711.3.partial", "checkpoints/other_solver.h5"})
    std::ofstream(folder / "run" / name) << "text";
  Scene other = scene;
  other.output.fields_every = 0;
  state = at_rest();
  const RunDirectory run(folder / "run", one_triangle(), other, ExistingRun::replace, 1, state);
  std::set<std::string> left;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "run"))
    if (!entry.is_directory()) left.insert(entry.path().lexically_proximate(folder / "run").string());
  EXPECT_EQ(left, (std::set<std::string>{"scene_resolved.toml", "time_series.csv", "membrane.csv",
                                         "notes.txt", "speed_of_my_own.png", "checkpoints/other_solver.h5"}));
}

TEST_F(RunDirectoryTest, ARunThatCannotBeRemovedWholeIsKeptWhole) {
  const Scene scene = two_periods();
  State state = at_rest();
  {
    RunDirectory run(folder / "run", one_triangle(), scene, ExistingRun::refuse, 1, state);
    record(run, 1, 8);
  }
  std::filesystem::create_directories(folder / "run" / "speed.png" / "in_a_folder");
  const auto table = read_text_file(folder / "run" / "time_series.csv");
  EXPECT_THROW(RunDirectory(folder / "run", one_triangle(), scene, ExistingRun::replace, 1, state),
               InputError);
  EXPECT_EQ(read_text_file(folder / "run" / "time_series.csv"), table);
  EXPECT_TRUE(newest_checkpoint(folder / "run" / "checkpoints"));
}

TEST_F(RunDirectoryTest, AnEndBelowWhatIsThereIsRefused) {
  Scene scene = two_periods();
  State state = at_rest();
  {
    RunDirectory run(folder / "run", one_triangle(), scene, ExistingRun::refuse, 1, state);
    record(run, 1, 9);
  }
  scene.time.periods = 1; // ends at step 8, one before the last row
  try {
    check_run_directory(folder / "run", scene, ExistingRun::go_on);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("time.periods asks for 8"), std::string::npos) << error.what();
  }
  EXPECT_EQ(read_time_series(folder / "run" / "time_series.csv").rows(), 9u);
}

TEST_F(RunDirectoryTest, AnOlderCheckpointStandsInForADamagedOne) {
  const Scene scene = two_periods();
  const auto checkpoints = folder / "run" / "checkpoints";
  const auto start = [&] {
    State state = at_rest();
    RunDirectory run(folder / "run", one_triangle(), scene, ExistingRun::replace, 1, state);
    record(run, 1, 11); // checkpoints at 4 and 8
  };
  const auto cut = [](const std::filesystem::path& file, std::uintmax_t size) {
    std::filesystem::resize_file(file, size);
  };
  const auto lines = [&](const char* table, std::size_t kept) { // a table that lost its last rows
    const auto text = read_text_file(folder / "run" / table);
    std::size_t end = 0;
    for (std::size_t k = 0; k <= kept; ++k) end = text.find('\n', end) + 1;
    std::ofstream(folder / "run" / table) << text.substr(0, end) << std::string(20, '\0') << "\n";
  };
  const std::vector<std::function<void()>> damages = {
      [&] { cut(checkpoints / "checkpoint_8.h5", 3000); }, [&] { cut(checkpoints / "checkpoint_8.h5", 0); },
      [&] { lines("time_series.csv", 6); }, [&] { lines("membrane.csv", 4); }};
  for (std::size_t k = 0; k < damages.size(); ++k) {
    start();
    damages[k]();
    State state = at_rest();
    RunDirectory run(folder / "run", one_triangle(), scene, ExistingRun::go_on, 1, state);
    EXPECT_EQ(state.step, 4) << k;
    EXPECT_EQ(state.x[0], made_up_state(4).x[0]);
    EXPECT_EQ(run.damaged().size(), 1u);
    record(run, 5, 11);
    EXPECT_EQ(load_checkpoint(checkpoints / "checkpoint_8.h5", stamp_scene(scene)).step, 8);
  }
  // Where none is whole, nothing is thrown away in silence.
  start();
  for (const char* name : {"checkpoint_4.h5", "checkpoint_8.h5"}) cut(checkpoints / name, 1000);
  State state = at_rest();
  EXPECT_THROW(RunDirectory(folder / "run", one_triangle(), scene, ExistingRun::go_on, 1, state), InputError);
  EXPECT_EQ(read_time_series(folder / "run" / "time_series.csv").rows(), 11u);
}

TEST_F(RunDirectoryTest, ACheckpointOfALaterVersionIsNotReplacedByAnOlderOne) {
  const Scene scene = two_periods();
  const auto newest = folder / "run" / "checkpoints" / "checkpoint_8.h5";
  {
    State state = at_rest();
    RunDirectory run(folder / "run", one_triangle(), scene, ExistingRun::replace, 1, state);
    record(run, 1, 11); // checkpoints at 4 and 8
  }
  auto later = Hdf5File::create(newest);
  later.write_attribute("/", "format", "undula checkpoint 3");
  later.commit();
  State state = at_rest();
  EXPECT_THROW(RunDirectory(folder / "run", one_triangle(), scene, ExistingRun::go_on, 1, state),
               LaterFormatError);
  EXPECT_TRUE(std::filesystem::exists(newest));
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

TEST(RunDirectoryChecks, CheckpointsComeByThemselves) {
  Scene pump;
  pump.time.steps_per_period = 8;
  pump.time.factor_every = 1;
  ASSERT_EQ(pump.output.checkpoint_every, automatic_checkpoints);
  EXPECT_FALSE(checkpoint_due(pump, 7, 0, 1));
  EXPECT_TRUE(checkpoint_due(pump, 8, 0, 1));
  EXPECT_FALSE(checkpoint_due(pump, 9, 8, 1));
  EXPECT_TRUE(checkpoint_due(pump, 9, 8, 61)); // seconds
  pump.time.factor_every = 3;                  // only after steps that a restart repeats
  EXPECT_FALSE(checkpoint_due(pump, 8, 0, 61));
  EXPECT_TRUE(checkpoint_due(pump, 9, 0, 1));
  Scene stated = pump;
  stated.problem.general = true;
  EXPECT_FALSE(checkpoint_due(stated, 9, 0, 1));
  EXPECT_TRUE(checkpoint_due(stated, 9, 0, 61));
  stated.output.checkpoint_every = 0;
  EXPECT_FALSE(checkpoint_due(stated, 9, 0, 1e9));
}

TEST(RunDirectoryChecks, CheckpointsHaveToFallOnFreshFactorisations) {
  Scene scene;
  scene.time.factor_every = 4;
  for (const int good : {automatic_checkpoints, 0, 4, 8}) {
    scene.output.checkpoint_every = good;
    EXPECT_NO_THROW(check_checkpoint_interval(scene));
  }
  scene.output.checkpoint_every = 6;
  EXPECT_THROW(check_checkpoint_interval(scene), InputError);
}

} // namespace
} // namespace undula::fom
