// `undula solve` and `undula validate scene.toml` as a user meets them, on a pump coarse enough for seconds.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "apps/apps.hpp"
#include "fom/output/checkpoint.hpp"
#include "fom/output/time_series.hpp"
#include "rom/base/hdf5_file.hpp"
#include "run_undula.hpp"
#include "tests/unit/apps/final_state.hpp"

namespace undula::apps {
namespace {

using Words = std::vector<std::string>;

constexpr int steps_per_period = 24;

Words coarse(const std::string& command, const Words& more) {
  Words words = {command, UNDULA_SOURCE_DIR "/data/scenes/wave_pump_fixed.toml"};
  for (const char* setting :
       {"mesh.gap_elements=2", "mesh.channel_size_mm=2", "mesh.membrane_size_mm=1", "mesh.growth=0.6",
        "time.steps_per_period=24", "training.snapshots_per_period=24"}) {
    words.insert(words.end(), {"--set", setting});
  }
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

void expect_done(const Outcome& outcome) { ASSERT_EQ(outcome.exit_code, 0) << outcome.err; }

void expect_same_run(const std::filesystem::path& a, const std::filesystem::path& b) {
  for (const char* name : {"time_series.csv", "membrane.csv", "cycle_means.csv", "envelope.csv"}) {
    EXPECT_FALSE(text_of(a / name).empty()) << name;
    EXPECT_EQ(text_of(a / name), text_of(b / name)) << name;
  }
  EXPECT_EQ(final_state(a), final_state(b));
}

double mean_outflow(const std::filesystem::path& folder) {
  const TimeSeries table = read_time_series(folder / "time_series.csv");
  return summarise_cycles(table, steps_per_period)
      .mean.at(table.columns.size() - 1); // first column of period 2
}

TEST(SolveCommand, StopAndRestartRepeatsTheRunBitForBit) {
  for (const char* factor_every : {"1", "4"}) {
    const ScratchFolder folder;
    const Words settings = {"--set", std::string("time.factor_every=") + factor_every,
                            "--set", "output.fields_every=12",
                            "--set", "output.checkpoint_every=8"};
    const auto run = [&](const char* output, const char* periods, bool restart) {
      Words words = settings;
      words.insert(words.end(), {"--set", std::string("time.periods=") + periods, "--output", output});
      if (restart) {
        words.push_back("--restart");
      }
      expect_done(run_undula(coarse("solve", words), folder.path()));
    };
    run("through", "2", false);
    run("stopped", "1", false);
    run("stopped", "2", true);
    expect_same_run(folder.path() / "through", folder.path() / "stopped");
    EXPECT_EQ(read_time_series(folder.path() / "through" / "time_series.csv").rows(), 2u * steps_per_period);
    for (const char* index : {"fluid.xdmf", "solids.xdmf"}) {
      EXPECT_EQ(occurrences(text_of(folder.path() / "stopped" / index), "<Time "), 4) << index;
    }
  }
}

TEST(SolveCommand, AKillAtAnyMomentLeavesARunThatGoesOn) {
  const ScratchFolder folder;
  const Words settings = {"--set", "time.periods=2",        "--set",   "output.checkpoint_every=1",
                          "--set", "output.fields_every=1", "--output"};
  const auto solve = [&](const char* output) {
    Words words = coarse("solve", settings);
    words.push_back(output);
    return words;
  };
  expect_done(run_undula(solve("whole"), folder.path()));

  Words words = solve("killed");
  words.insert(words.begin(), UNDULA_BINARY);
  std::vector<char*> arguments;
  for (std::string& word : words) {
    arguments.push_back(word.data());
  }
  arguments.push_back(nullptr);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    if (chdir(folder.path().c_str()) == 0) {
      execv(UNDULA_BINARY, arguments.data());
    }
    _exit(127);
  }
  const auto killed = folder.path() / "killed";
  for (int waited = 0; waited < 6000 && !newest_checkpoint(killed / "checkpoints"); ++waited) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  std::random_device seed;
  std::this_thread::sleep_for(std::chrono::milliseconds(std::uniform_int_distribution<int>(0, 300)(seed)));
  kill(child, SIGKILL);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status)) << "the run ended before the kill";

  EXPECT_GE(read_time_series(killed / "time_series.csv").rows(), 1u);
  words = solve("killed");
  words.push_back("--restart");
  const Outcome outcome = run_undula(words, folder.path());
  expect_done(outcome);
  EXPECT_EQ(outcome.err.find("goes on from step 0"), std::string::npos) << outcome.err;
  expect_same_run(folder.path() / "whole", killed);
  for (const char* index : {"fluid.xdmf", "solids.xdmf"}) {
    EXPECT_EQ(occurrences(text_of(killed / index), "<Time "), 2 * steps_per_period) << index;
  }
}

TEST(SolveCommand, TwoRanksGiveTheSameMeanFlow) {
  const ScratchFolder folder;
  const Words words = coarse("solve", {"--set", "time.periods=2", "--output"});
  Words one = words;
  one.push_back("one");
  expect_done(run_undula(one, folder.path()));
  std::string command = "cd '" + folder.path().string() +
                        "' && mpirun --allow-run-as-root --oversubscribe --bind-to none -np 2 " UNDULA_BINARY;
  for (const std::string& word : words) {
    command += " '" + word + "'";
  }
  ASSERT_EQ(std::system((command + " two >out.txt 2>err.txt").c_str()), 0)
      << text_of(folder.path() / "err.txt");
  // Told once, not once per rank.
  EXPECT_EQ(occurrences(text_of(folder.path() / "out.txt"), "outflow (l/min)"), 1);
  const double flow = mean_outflow(folder.path() / "one");
  EXPECT_NE(flow, 0.0);
  EXPECT_NEAR(mean_outflow(folder.path() / "two"), flow, 1e-8 * std::abs(flow));
}

TEST(SolveCommand, ARunIsNotOverwrittenSilently) {
  const ScratchFolder folder;
  const Words first = coarse("solve", {"--set", "time.periods=1", "--output", "run"});
  expect_done(run_undula(first, folder.path()));
  const std::string before = text_of(folder.path() / "run" / "time_series.csv");

  Words other = first;
  other.insert(other.end(), {"--set", "operating_point.head_mmHg=12"});
  Words restart = other;
  restart.push_back("--restart");
  for (const Words& words : {first, other, restart}) {
    const Outcome refused = run_undula(words, folder.path());
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_EQ(refused.out, "");
    EXPECT_NE(refused.err.find("wave_pump_fixed"), std::string::npos) << refused.err;
    EXPECT_EQ(text_of(folder.path() / "run" / "time_series.csv"), before);
  }
  other.push_back("--force");
  expect_done(run_undula(other, folder.path()));
  EXPECT_NE(text_of(folder.path() / "run" / "time_series.csv"), before);
}

TEST(SolveCommand, AFailureKeepsTheLastGoodStateAndExitsWithOne) {
  const ScratchFolder folder;
  expect_done(run_undula(coarse("solve", {"--set", "time.periods=1", "--output", "run"}), folder.path()));
  const Outcome failed =
      run_undula(coarse("solve", {"--set", "time.periods=2", "--output", "run", "--restart", "--",
                                  "-fsi_ksp_type", "gmres", "-fsi_pc_type", "none", "-fsi_ksp_max_it", "1"}),
                 folder.path());
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_EQ(failed.out, "");
  EXPECT_NE(failed.err.find("step 25"), std::string::npos) << failed.err;
  EXPECT_NE(failed.err.find("checkpoint_24.h5"), std::string::npos) << failed.err;
  // The run can still go on from there.
  expect_done(run_undula(coarse("solve", {"--set", "time.periods=2", "--output", "run", "--restart"}),
                         folder.path()));
}

TEST(SolveCommand, WrongInputIsRefusedBeforeAnythingIsWritten) {
  const ScratchFolder folder;
  const std::vector<std::pair<Words, const char*>> cases = {
      {{"--set", "output.checkpoint_every=5", "--set", "time.factor_every=2"}, "output.checkpoint_every = 5"},
      {{"--set", "operating_point.stroke_cm=1"}, "operating_point.stroke_mm"},
      {{"stray"}, "stray"}};
  for (const auto& [words, expected] : cases) {
    const Outcome refused = run_undula(coarse("solve", words), folder.path());
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.err.find(expected), std::string::npos) << refused.err;
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(ValidateCommand, ASceneIsRunAtEveryHead) {
  const ScratchFolder folder;
  const Words settings = {"--set", "time.periods=2", "--json"};
  Words words = coarse("validate", settings);
  words.insert(words.end(),
               {"--head", "50,55", "--data", UNDULA_SOURCE_DIR "/data/measured/corwave_120hz_0.53mm.csv"});
  const Outcome validated = run_undula(words, folder.path());
  expect_done(validated);
  const auto points = nlohmann::json::parse(validated.out)["points"];
  ASSERT_EQ(points.size(), 2u);

  words = coarse("solve", settings);
  words.insert(words.end(), {"--set", "operating_point.head_mmHg=55"});
  const Outcome solved = run_undula(words, folder.path());
  expect_done(solved);
  // Not periodic after two periods, too few for a mean: the last one counts.
  const auto periods = nlohmann::json::parse(solved.out)["periods"];
  const double flow = periods[1]["outflow_l_per_min"].get<double>();
  EXPECT_NEAR(points[1]["computed_l_per_min"].get<double>(), flow, 1e-10);
  EXPECT_GT(std::abs(points[0]["computed_l_per_min"].get<double>() - flow), 1e-4);
}

} // namespace
} // namespace undula::apps
