// From a scene to an emulator to a curve, through the commands: on thin gaps, whose runs take a fifth of a
// second.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/apps.hpp"
#include "tests/unit/apps/run_undula.hpp"

namespace undula::apps {
namespace {

using Words = std::vector<std::string>;

const std::string scene = UNDULA_SOURCE_DIR "/data/scenes/wave_pump_bench.toml";

Words train_words(Words more = {}) {
  Words words = {"train", scene, "--output", "pump.h5"};
  for (const char* setting :
       {"training.model=emulator", "training.frequency_low_Hz=120", "training.frequency_high_Hz=120",
        "training.voltage_low_V=36", "training.voltage_high_V=48", "training.head_low_mmHg=20",
        "training.head_high_mmHg=65", "training.training_points=10", "training.held_out_points=6"}) {
    words.insert(words.end(), {"--set", setting});
  }
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

nlohmann::json json_of(const Words& words, const ScratchFolder& folder) {
  const Outcome outcome = run_undula(words, folder.path());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return outcome.exit_code == 0 ? nlohmann::json::parse(outcome.out) : nlohmann::json();
}

class EmulatorCommands : public testing::Test {
protected:
  static void SetUpTestSuite() {
    folder = new ScratchFolder;
    built = json_of(train_words({"--json"}), *folder);
  }
  static void TearDownTestSuite() { delete folder; }

  void expect_refused(const Words& words, const std::string& text) {
    const Outcome outcome = run_undula(words, folder->path());
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find(text), std::string::npos) << "no \"" << text << "\" in\n" << outcome.err;
  }
  static inline ScratchFolder* folder = nullptr; ///< with pump.h5
  static inline nlohmann::json built;            ///< what training said
};

TEST_F(EmulatorCommands, TrainingKnowsHowGoodItIs) {
  ASSERT_EQ(built["runs"].size(), 20u); // 4 corners, 10 inside, 6 held out
  const double range = built["flow_range_l_per_min"];
  EXPECT_GT(range, 5);
  EXPECT_LT(built["held_out"]["rms_l_per_min"], 0.01 * range);
  EXPECT_GE(built["held_out"]["covered"], 0.8);
  EXPECT_LT(built["held_out"]["stated_over_true_median"], 6);
  EXPECT_GE(built["left_out"]["covered"], 0.9);
  EXPECT_TRUE(built["not_used"].empty());
}

TEST_F(EmulatorCommands, ACurveLiesOnTheScenesOwnWithinItsError) {
  const Words heads = {"--voltage", "42", "--head", "25,40,55", "--json"};
  Words emulated = {"hq", "pump.h5", "--frequency", "120"}, computed = {"hq", scene};
  emulated.insert(emulated.end(), heads.begin(), heads.end());
  computed.insert(computed.end(), heads.begin(), heads.end());
  const auto fast = json_of(emulated, *folder), slow = json_of(computed, *folder);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto &a = fast["points"][i], &b = slow["points"][i];
    const double error = std::abs(a["flow_l_per_min"].get<double>() - b["flow_l_per_min"].get<double>());
    EXPECT_GT(error, 0); // not the scene in disguise
    EXPECT_LT(error, 2 * a["error_l_per_min"].get<double>());
    EXPECT_LT(a["error_l_per_min"].get<double>(), 0.1);
    EXPECT_NEAR(a["holder"]["stroke_mm"].get<double>(), b["holder"]["stroke_mm"].get<double>(),
                0.02 * b["holder"]["stroke_mm"].get<double>());
    EXPECT_TRUE(a["inside_training_box"].get<bool>());
  }
}

// Outside of the box the emulator is not sure: the scene is run there, recorded, and learnt from.
TEST_F(EmulatorCommands, AHybridCurveRunsTheSceneWhereTheEmulatorIsNotSure) {
  const ScratchFolder own;
  std::filesystem::copy(folder->path() / "pump.h5", own.path() / "pump.h5");
  std::filesystem::copy(folder->path() / "pump.h5.runs", own.path() / "pump.h5.runs",
                        std::filesystem::copy_options::recursive);
  const auto count = [&] {
    std::size_t records = 0;
    for (const auto& entry : std::filesystem::directory_iterator(own.path() / "pump.h5.runs")) {
      records += entry.path().extension() == ".h5" && entry.path().filename() != "campaign.h5" ? 1 : 0;
    }
    return records;
  };
  const Words train = train_words();
  Words ask = {"hq",     "pump.h5", "--frequency", "120",          "--voltage",
               "42",     "--head",  "40,100",      "--tolerance",  "0.05",
               "--then", scene,     "--campaign",  "pump.h5.runs", "--json"};
  const std::size_t before = count();
  // The folder is that of the scene with the settings that were trained.
  for (std::size_t k = 4; k < train.size(); ++k) {
    ask.push_back(train[k]);
  }
  const auto answer = json_of(ask, own);
  EXPECT_EQ(answer["points"][0]["tier"], "emulator");
  EXPECT_EQ(answer["points"][1]["tier"], "scene wave_pump_bench");
  EXPECT_LE(answer["points"][0]["error_l_per_min"].get<double>(), 0.05);
  EXPECT_EQ(count(), before + 1);
  const auto alone = json_of({"hq", scene, "--voltage", "42", "--head", "100", "--json"}, own);
  EXPECT_NEAR(answer["points"][1]["flow_l_per_min"].get<double>(),
              alone["points"][0]["flow_l_per_min"].get<double>(), 1e-6);
  // Asked again, the record answers.
  EXPECT_EQ(json_of(ask, own)["points"][1]["flow_l_per_min"], answer["points"][1]["flow_l_per_min"]);
  EXPECT_EQ(count(), before + 1);
}

TEST_F(EmulatorCommands, TrainingTakesRecordedRunsOfTheBoxWhenAsked) {
  Words words = train_words({"--campaign", "pump.h5.runs", "--json", "--with-recorded"});
  words[3] = "fewer.h5";
  for (std::string& word : words) {
    if (word == "training.training_points=10") {
      word = "training.training_points=4";
    }
  }
  const auto all = json_of(words, *folder);
  std::erase(words, "--with-recorded");
  const auto planned = json_of(words, *folder);
  EXPECT_GT(all["runs"].size(), planned["runs"].size());
  EXPECT_LT(all["left_out"]["rms_l_per_min"].get<double>(),
            planned["left_out"]["rms_l_per_min"].get<double>());
}

TEST_F(EmulatorCommands, SeveralCurvesAndASceneBesideTakeTheirVoltages) {
  const auto several = run_undula(
      {"hq", "pump.h5", "--frequency", "120", "--voltage", "40,46", "--head", "40"}, folder->path());
  EXPECT_EQ(several.exit_code, 0) << several.err;
  const auto at = [&](const std::string& voltage) {
    return json_of({"hq", "pump.h5", "--frequency", "120", "--voltage", voltage, "--head", "40", "--beside",
                    scene, "--json"},
                   *folder);
  };
  for (const char* voltage : {"38", "46"}) {
    const auto both = at(voltage);
    EXPECT_NEAR(both["points"][0]["flow_l_per_min"].get<double>(),
                both["points"][0]["beside"]["flow_l_per_min"].get<double>(), 0.1)
        << voltage;
  }
}

TEST_F(EmulatorCommands, OutsideOfItsBoxItSaysSoAndWrongQuestionsAreRefused) {
  const Outcome outcome =
      run_undula({"hq", "pump.h5", "--frequency", "120", "--voltage", "49", "--head", "70"}, folder->path());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("voltage 49 V is outside the trained 36 to 48 V"), std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.err.find("head 70 mmHg"), std::string::npos);
  expect_refused({"hq", "pump.h5", "--frequency", "120", "--stroke", "0.5", "--head", "40"},
                 "no voltage, but a stroke of 0.5 mm");
  expect_refused({"hq", "pump.h5", "--frequency", "120", "--voltage", "-3", "--head", "40"}, "> 0");
  expect_refused({"hq", "pump.h5", "--voltage", "40", "--head", "40"}, "--frequency");
  expect_refused(
      {"hq", "pump.h5", "--frequency", "120", "--voltage", "40", "--set", "mesh.growth=1", "--head", "40"},
      "no keys to override");
  expect_refused(train_words({"--set", "training.voltage_low_V=60"}), "voltage");
  // Another scene does not take the place of this emulator, and has runs of its own.
  expect_refused(train_words({"--set", "membrane.poisson=0.48", "--campaign", "other"}), "another scene");
  expect_refused(train_words({"--set", "membrane.poisson=0.48", "--force"}), "campaign of another scene");
}

TEST_F(EmulatorCommands, RunsAreAddedWhereItKnowsLeastAndEarlierOnesKept) {
  const Words words = train_words({"--set", "training.held_out_points=0", "--set",
                                   "training.training_points=4", "--tolerance", "0.03", "--json", "--force"});
  const auto added = json_of(words, *folder);
  const auto runs = added["runs"].size();
  EXPECT_GT(runs, 8u);
  EXPECT_LT(runs, 40u);
  const auto again = json_of(words, *folder); // by the same runs
  EXPECT_EQ(again["runs"], added["runs"]);
  Words few = words;
  few.insert(few.end(), {"--runs", "9"});
  const Outcome outcome = run_undula(few, folder->path());
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.err.find("not reached with 9 runs"), std::string::npos) << outcome.err;
  expect_refused(
      {"train", UNDULA_SOURCE_DIR "/data/scenes/wave_pump_fixed_training.toml", "--tolerance", "0.1"},
      "does not choose its runs");

  const auto count = [&] {
    return std::distance(std::filesystem::directory_iterator(folder->path() / "pump.h5.runs"), {});
  };
  const auto before = count();
  const auto larger = json_of(train_words({"--set", "training.held_out_points=0", "--json", "--set",
                                           "training.training_points=14", "--force"}),
                              *folder);
  EXPECT_EQ(larger["runs"].size(), 18u);
  EXPECT_EQ(count(), before + 4);
  EXPECT_EQ(larger["held_out"]["runs"], 0);
}

} // namespace
} // namespace undula::apps
