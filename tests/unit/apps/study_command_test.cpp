// undula study, through the binary.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/unit/apps/run_undula.hpp"
#include "tests/unit/apps/small_scene.hpp"

namespace undula::apps {
namespace {

using Words = std::vector<std::string>;
using Json = nlohmann::json;

const std::string scene = UNDULA_SOURCE_DIR "/data/scenes/peristaltic_pump.toml";

Words study(const Words& more) {
  Words words = {"study",          scene,      "--set", "time.steps_per_period=36", "--set",
                 "time.periods=3", "--output", "s"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

int records_in(const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder)) return 0;
  return static_cast<int>(
      std::ranges::count_if(std::filesystem::directory_iterator(folder), [](const auto& entry) {
        return entry.path().extension() == ".h5" && entry.path().filename() != "study.h5";
      }));
}

TEST(StudyCommand, LeavesTableJsonAndPicturesAndIsFreeTheSecondTime) {
  const ScratchFolder folder;
  const Words words = study({"--vary", "rollers.occlusion=0.6:0.95:4", "--vary",
                             "operating_point.frequency_Hz=0.4:1.2:3", "--plot"});
  const Outcome first = run_undula(words, folder.path());
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_NE(first.out.find("rollers.occlusion"), std::string::npos);
  EXPECT_NE(first.out.find("first-order index"), std::string::npos);
  const auto results = folder.path() / "s";
  EXPECT_EQ(records_in(results), 12);
  EXPECT_EQ(occurrences(text_of(results / "table.csv"), "\n"), 13);
  for (const char* file : {"study.json", "runs.png", "sensitivities.png"})
    EXPECT_TRUE(std::filesystem::exists(results / file)) << file;

  Words as_json = words;
  as_json.push_back("--json");
  const Outcome second = run_undula(as_json, folder.path());
  ASSERT_EQ(second.exit_code, 0) << second.err;
  const Json found = Json::parse(second.out);
  EXPECT_EQ(found["plan"], "full");
  ASSERT_EQ(found["runs"].size(), 12u);
  EXPECT_EQ(second.out, text_of(results / "study.json"));
  // The plug goes with the speed: where the hose is nearly closed, three times the speed is three times the
  // flow.
  const double slow = found["runs"][9]["quantities"]["flow_l_per_min"],
               fast = found["runs"][11]["quantities"]["flow_l_per_min"];
  EXPECT_NEAR(fast / slow, 3, 0.1);
  const auto& keys = found["sensitivities"]["flow_l_per_min"]["keys"];
  EXPECT_GT(keys[1]["first_order_index"].get<double>(), 0.3);
  EXPECT_GT(keys[1]["standardised_coefficient"].get<double>(), 0.5);
}

TEST(StudyCommand, ASpaceFillingPlanCanBeMadeLarger) {
  const ScratchFolder folder;
  const Words ranges = {"--vary", "rollers.occlusion=0.6:0.95", "--vary", "hose.bore_mm=24:36", "--points"};
  Words few = study(ranges), many = study(ranges);
  few.push_back("3"), many.push_back("5");
  ASSERT_EQ(run_undula(few, folder.path()).exit_code, 0);
  const auto kept = std::filesystem::last_write_time(folder.path() / "s" / "study.h5");
  EXPECT_EQ(records_in(folder.path() / "s"), 3);
  const Outcome outcome = run_undula(many, folder.path());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(records_in(folder.path() / "s"), 5);
  EXPECT_EQ(std::filesystem::last_write_time(folder.path() / "s" / "study.h5"), kept);
}

TEST(StudyCommand, AKilledStudyGoesOn) {
  const ScratchFolder folder;
  const Words words =
      study({"--vary", "rollers.occlusion=0.5:0.95:40", "--set", "time.steps_per_period=360"});
  const pid_t child = fork();
  if (child == 0) {
    Words all = words;
    all.insert(all.begin(), UNDULA_BINARY);
    std::vector<char*> arguments;
    for (std::string& word : all) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    if (chdir(folder.path().c_str()) == 0 && freopen("out.txt", "w", stdout) != nullptr &&
        freopen("err.txt", "w", stderr) != nullptr)
      execv(UNDULA_BINARY, arguments.data());
    _exit(127);
  }
  for (int waited = 0; waited < 3000 && records_in(folder.path() / "s") < 3; ++waited)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status)) << "the study ended before it could be killed";
  const int kept = records_in(folder.path() / "s");
  EXPECT_GE(kept, 3);
  std::vector<std::pair<std::filesystem::path, std::filesystem::file_time_type>> before;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "s"))
    if (entry.path().extension() == ".h5") before.emplace_back(entry.path(), entry.last_write_time());
  const Outcome outcome = run_undula(words, folder.path());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(records_in(folder.path() / "s"), 40);
  for (const auto& [file, time] : before) EXPECT_EQ(std::filesystem::last_write_time(file), time) << file;
}

TEST(StudyCommand, ValuesThatTheSceneRefusesAreRowsOfTheTable) {
  const ScratchFolder folder;
  // From about 110 mm of radius on, the roller does not fit into the ring.
  const Outcome outcome = run_undula(study({"--vary", "rollers.radius_mm=60:115:3"}), folder.path());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("refused"), std::string::npos) << outcome.out;
  EXPECT_NE(text_of(folder.path() / "s" / "table.csv").find("refused"), std::string::npos);
  const Outcome none =
      run_undula({"study", scene, "--vary", "rollers.radius_mm=113:120:3", "--output", "n"}, folder.path());
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_NE(none.err.find("no run of the study has a result"), std::string::npos) << none.err;
}

TEST(StudyCommand, TakesScenesThatAreNoPumps) {
  const ScratchFolder folder;
  write_small_scene(folder.path() / "scene.toml");
  const Outcome outcome = run_undula({"study", "scene.toml", "--vary", "fluid.viscosity_poise=0.5:1:2",
                                      "--output", "s", "--quantity", "mean_speed_max_cm_per_s"},
                                     folder.path());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("ended"), std::string::npos) << outcome.out;
}

TEST(StudyCommand, ItsFolderIsKeptFromOthers) {
  const ScratchFolder folder;
  const Words ranges = {"--vary", "rollers.occlusion=0.6:0.9:2"};
  ASSERT_EQ(run_undula(study(ranges), folder.path()).exit_code, 0);
  // A run.
  const Outcome run = run_undula({"solve", scene, "--output", "s", "--force"}, folder.path());
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("that of a study"), std::string::npos) << run.err;
  // A study of another fluid.
  Words other = study(ranges);
  other.insert(other.end(), {"--set", "fluid.viscosity_poise=0.02"});
  const Outcome refused = run_undula(other, folder.path());
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("fluid.viscosity_poise: was 0.01, is 0.02"), std::string::npos) << refused.err;
  EXPECT_EQ(records_in(folder.path() / "s"), 2);
}

TEST(StudyCommand, WrongRangesAreRefusedBeforeTheFolderIsMade) {
  const ScratchFolder folder;
  const std::vector<std::pair<Words, std::string>> cases = {
      {{"--vary", "rollers.occlusion"}, "cannot be read"},
      {{"--vary", "rollers.occlusion=0.5"}, "cannot be read"},
      {{"--vary", "rollers.occlusion=0.5:x"}, "cannot be read"},
      {{"--vary", "rollers.occlusion=0.5:0.9:1"}, "cannot be read"},
      {{"--vary", "rollers.occlusion=0.5:1.9"}, "(0, 1]"},
      {{"--vary", "rollers.oclusion=0.5:0.9"}, "\"rollers.occlusion\""},
      {{"--vary", "rollers.occlusion=0.5:0.9:3", "--points", "7"}, "--points"},
  };
  for (const auto& [words, text] : cases) {
    const Outcome outcome = run_undula(study(words), folder.path());
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
    EXPECT_EQ(occurrences(outcome.err, "\n  allowed: "), 1) << outcome.err;
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  }
}

} // namespace
} // namespace undula::apps
