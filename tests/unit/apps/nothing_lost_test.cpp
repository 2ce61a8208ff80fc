// Runs that meet signals, full disks, second processes and files of others: nothing is lost, mixed or
// replaced unasked.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "apps/apps.hpp"
#include "fom/output/checkpoint.hpp"
#include "fom/output/time_series.hpp"
#include "tests/unit/apps/run_undula.hpp"
#include "tests/unit/apps/small_scene.hpp"
#include "tests/unit/apps/test_model.hpp"

namespace undula::apps {
namespace {

using Words = std::vector<std::string>;

class NothingLost : public testing::Test {
protected:
  void SetUp() override { write_small_scene(folder.path() / "scene.toml"); }

  Outcome solve(const Words& more, const char* output = "run") const {
    Words words = {"solve", "scene.toml", "--output", output};
    words.insert(words.end(), more.begin(), more.end());
    return run_undula(words, folder.path());
  }

  /// Starts `undula words...` with stderr in err.txt and stdout in out.txt.
  pid_t start(Words words) const {
    words.insert(words.begin(), UNDULA_BINARY);
    std::vector<char*> arguments;
    for (std::string& word : words) {
      arguments.push_back(word.data());
    }
    arguments.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
      const bool there = chdir(folder.path().c_str()) == 0;
      for (const auto& [name, descriptor] : {std::pair("out.txt", 1), std::pair("err.txt", 2)}) {
        dup2(open(name, O_WRONLY | O_CREAT | O_TRUNC, 0644), descriptor);
      }
      if (there) {
        execv(UNDULA_BINARY, arguments.data());
      }
      _exit(127);
    }
    return child;
  }

  void wait_for_rows(std::size_t rows) const {
    for (int waited = 0; waited < 6000; ++waited) {
      std::error_code none;
      if (std::filesystem::file_size(run() / "time_series.csv", none) > 0 && !none &&
          read_time_series(run() / "time_series.csv").rows() >= rows) {
        return;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    FAIL() << "no rows: " << text_of(folder.path() / "err.txt");
  }

  static int exit_code(pid_t child) {
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  [[nodiscard]] std::filesystem::path run() const { return folder.path() / "run"; }

  ScratchFolder folder;
};

TEST_F(NothingLost, ASignalEndsTheStepSavesAndSaysSo) {
  ASSERT_EQ(solve({"--set", "time.end_s=3"}, "whole").exit_code, 0);
  for (const int signal : {SIGTERM, SIGINT}) {
    std::filesystem::remove_all(run()); // rows of the run before would be taken for its own
    const pid_t child = start({"solve", "scene.toml", "--output", "run", "--set", "time.end_s=3"});
    wait_for_rows(3);
    kill(child, signal);
    EXPECT_EQ(exit_code(child), 1);
    const auto saved = newest_checkpoint(run() / "checkpoints");
    ASSERT_TRUE(saved);
    const std::string told = text_of(folder.path() / "err.txt");
    EXPECT_NE(told.find(signal == SIGTERM ? "stopped by SIGTERM" : "stopped by SIGINT"), std::string::npos)
        << told;
    EXPECT_NE(told.find(saved->filename().string()), std::string::npos) << told;
    const auto rows = read_time_series(run() / "time_series.csv").rows();
    EXPECT_EQ(saved->filename().string(), "checkpoint_" + std::to_string(rows) + ".h5");
    EXPECT_LT(rows, 300u);
    ASSERT_EQ(solve({"--restart", "--set", "time.end_s=3"}).exit_code, 0);
    EXPECT_EQ(text_of(run() / "time_series.csv"), text_of(folder.path() / "whole" / "time_series.csv"));
  }
}

TEST_F(NothingLost, ASecondRunInTheSameFolderIsRefused) {
  const pid_t child = start({"solve", "scene.toml", "--output", "run", "--set", "time.end_s=40"});
  wait_for_rows(2);
  for (const char* how : {"--restart", "--force", "--json"}) {
    const Outcome second = solve({how});
    EXPECT_EQ(second.exit_code, 2) << how;
    EXPECT_NE(second.err.find("process " + std::to_string(child)), std::string::npos) << second.err;
  }
  kill(child, SIGKILL);
  EXPECT_EQ(exit_code(child), -1);
  const Outcome after = solve({"--force"}); // a killed holder blocks nobody
  EXPECT_EQ(after.exit_code, 0) << after.err;
}

TEST_F(NothingLost, ARunIsNotCutShort) {
  ASSERT_EQ(solve({}).exit_code, 0);
  const Outcome shorter = solve({"--restart", "--set", "time.end_s=0.05"});
  EXPECT_EQ(shorter.exit_code, 2);
  EXPECT_NE(shorter.err.find("time.end_s"), std::string::npos) << shorter.err;
  EXPECT_EQ(read_time_series(run() / "time_series.csv").rows(), 10u);
}

// The inflow still rises when the first run ends, so that a longer scene by itself would have other weights.
TEST_F(NothingLost, AProlongedRunKeepsItsReferenceVelocity) {
  const auto velocity = [&] {
    return text_of(run() / "scene_resolved.toml").find("velocity_cm_per_s = 0.5\n");
  };
  ASSERT_EQ(solve({"--set", "time.end_s=0.05"}).exit_code, 0);
  ASSERT_NE(velocity(), std::string::npos);
  const Outcome longer = solve({"--restart"});
  EXPECT_EQ(longer.exit_code, 0) << longer.err;
  EXPECT_NE(velocity(), std::string::npos);
  EXPECT_EQ(read_time_series(run() / "time_series.csv").rows(), 10u);
  const Outcome stated =
      solve({"--restart", "--set", "time.end_s=0.2", "--set", "stabilisation.reference_velocity_cm_per_s=1"});
  EXPECT_EQ(stated.exit_code, 2);
  EXPECT_NE(stated.err.find("reference_velocity_cm_per_s: was 0.5, is 1.0"), std::string::npos) << stated.err;
}

TEST_F(NothingLost, TheKeyThatForbidsARestartIsNamed) {
  ASSERT_EQ(solve({}).exit_code, 0);
  const Outcome other = solve({"--restart", "--set", "time.step_s=0.02"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(other.err.find("time.step_s: was 0.01, is 0.02"), std::string::npos) << other.err;
}

TEST_F(NothingLost, AFullDiskIsOneMessageAndTheRunGoesOnAfterwards) {
  ASSERT_EQ(solve({"--set", "time.end_s=1"}, "whole").exit_code, 0);
  // A limit on the size of files stands for a full disk: the table reaches it, then nothing more is written.
  const std::string command = "cd '" + folder.path().string() +
                              "' && export PMIX_MCA_gds=hash && ulimit -f 12 && '" UNDULA_BINARY
                              "' solve scene.toml --output run --set time.end_s=1 >out.txt 2>err.txt";
  const int status = std::system(("bash -c \"" + command + "\"").c_str());
  EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 1);
  const std::string told = text_of(folder.path() / "err.txt");
  EXPECT_NE(told.find("free space on the disk"), std::string::npos) << told;
  EXPECT_EQ(told.find("HDF5-DIAG"), std::string::npos) << told;
  EXPECT_EQ(told.find("HDF5:"), std::string::npos) << told;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(run())) {
    EXPECT_NE(entry.path().extension(), ".partial") << entry.path();
  }
  ASSERT_EQ(solve({"--restart", "--set", "time.end_s=1"}).exit_code, 0);
  EXPECT_EQ(text_of(run() / "time_series.csv"), text_of(folder.path() / "whole" / "time_series.csv"));
}

TEST_F(NothingLost, ResultsThatCannotBePrintedAreAFailure) {
  const auto model = write_small_model(folder.path()).string();
  for (const std::string& words :
       {"hq '" + model + "' --frequency 120 --stroke 0.53 --head 50,60 --json",
        std::string("check scene.toml"), std::string("solve scene.toml --output full --force"),
        std::string("--help")}) {
    for (const char* target : {">/dev/full", ">&-"}) {
      const std::string command =
          "cd '" + folder.path().string() + "' && '" UNDULA_BINARY "' " + words + " " + target + " 2>err.txt";
      const int status = std::system(command.c_str());
      EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 1) << words << target;
      EXPECT_NE(text_of(folder.path() / "err.txt").find("could not be printed"), std::string::npos) << words;
    }
  }
  EXPECT_EQ(read_time_series(folder.path() / "full" / "time_series.csv").rows(), 10u);
}

TEST_F(NothingLost, ALogThatIsNoTerminalGetsLinesWithTheTimeLeft) {
  const Outcome outcome = solve({"--set", "time.end_s=0.4"});
  EXPECT_EQ(occurrences(outcome.err, " %  "), 10) << outcome.err;
  EXPECT_NE(outcome.err.find("solve  50 %  20/40  0:"), std::string::npos) << outcome.err;
}

TEST_F(NothingLost, AFlowThatIsNoNumberIsAFailure) {
  const auto model = write_small_model(folder.path()).string();
  const auto hq = [&](const char* heads) {
    return run_undula({"hq", model, "--frequency", "120", "--stroke", "0.53", "--head", heads, "--json"},
                      folder.path());
  };
  EXPECT_EQ(hq("1e300").exit_code, 1);
  EXPECT_EQ(hq("1e300").out, "");
  const Outcome mixed = hq("50,1e300");
  EXPECT_NE(mixed.err.find("no finite state"), std::string::npos) << mixed.err;
  const auto points = nlohmann::json::parse(mixed.out)["points"];
  EXPECT_EQ(points[0]["periodic"], true);
  EXPECT_EQ(points[1]["periodic"], false);
  EXPECT_TRUE(points[1]["flow_l_per_min"].is_null());
}

TEST_F(NothingLost, AFileThatIsNoModelIsNotReplacedByOne) {
  std::ofstream(folder.path() / "model.h5") << "last year's model";
  write_small_model(folder.path());
  const std::string scene = UNDULA_SOURCE_DIR "/data/scenes/wave_pump_fixed_training.toml";
  for (const auto& words : {Words{"--output", "model.h5", "--force"}, Words{"--output", "small.h5"}}) {
    Words all = {"train", scene, "--campaign", "campaign"};
    all.insert(all.end(), words.begin(), words.end());
    const Outcome outcome = run_undula(all, folder.path());
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_NE(outcome.err.find(words[1]), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(text_of(folder.path() / "model.h5"), "last year's model");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "campaign"));
}

TEST_F(NothingLost, APictureDoesNotReplaceWhatOthersNamedLikeItsData) {
  const auto model = write_small_model(folder.path()).string();
  const Words hq = {"hq",   model,    "--frequency", "120",    "--stroke",
                    "0.53", "--head", "50,60",       "--plot", "curve.png"};
  std::ofstream(folder.path() / "curve.dat") << "my data";
  EXPECT_EQ(run_undula(hq, folder.path()).exit_code, 2);
  EXPECT_EQ(text_of(folder.path() / "curve.dat"), "my data");
  std::filesystem::remove(folder.path() / "curve.dat");
  for (int again = 0; again < 2; ++again) {
    EXPECT_EQ(run_undula(hq, folder.path()).exit_code, 0);
  }
}

TEST_F(NothingLost, ASceneIsFoundBehindALinkToItsFolder) {
  std::filesystem::create_directories(folder.path() / "home");
  std::filesystem::create_directory_symlink(UNDULA_SOURCE_DIR "/data/scenes",
                                            folder.path() / "home" / "scenes");
  const Outcome outcome = run_undula({"check", "home/scenes/wave_pump_thin_gap.toml"}, folder.path());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
}

TEST_F(NothingLost, SolveDoesNotAskForWhatOnlyTrainNeeds) {
  const std::string scene = UNDULA_SOURCE_DIR "/data/scenes/wave_pump_thin_gap.toml";
  const Words words = {
      scene, "--set", "time.steps_per_period=100", "--set", "time.periods=1", "--set", "time.ramp_periods=1"};
  for (const char* command : {"check", "solve"}) {
    Words all = {command};
    all.insert(all.end(), words.begin(), words.end());
    const Outcome outcome = run_undula(all, folder.path());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  const Outcome trained = run_undula(
      {"train", UNDULA_SOURCE_DIR "/data/scenes/wave_pump_fixed.toml", "--set", "time.steps_per_period=100"},
      folder.path());
  EXPECT_EQ(trained.exit_code, 2);
  EXPECT_NE(trained.err.find("snapshots_per_period"), std::string::npos) << trained.err;
}

} // namespace
} // namespace undula::apps
