// From a scene to an emulator to a curve, through the commands: on thin gaps, whose runs take a fifth of a
// second.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "apps/apps.hpp"
#include "rom/emulator/emulator.hpp"
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
      "does not know this key");
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

/// Of two heads, the modulus, and the force per volt, which scales the voltage.
class FurtherInputs : public testing::Test {
protected:
  static void SetUpTestSuite() {
    folder = new ScratchFolder;
    Words words =
        train_words({"--json", "--set", R"(training.vary=["membrane.young_dyn_per_cm2=1.5e7:1.9e7"])",
                     "--set", "training.training_points=24"});
    built = json_of(words, *folder);
  }
  static void TearDownTestSuite() { delete folder; }
  void expect_refused(const Words& words, const std::string& text) {
    const Outcome outcome = run_undula(words, folder->path());
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find(text), std::string::npos) << "no \"" << text << "\" in\n" << outcome.err;
  }
  /// Of the emulator or of the scene at 40 V and 45 mmHg.
  nlohmann::json point(const std::string& file, Words settings, const std::string& voltage = "40") {
    Words words = {"hq", file, "--voltage", voltage, "--frequency", "120", "--head", "45", "--json"};
    words.insert(words.end(), settings.begin(), settings.end());
    return json_of(words, *folder)["points"][0];
  }
  static double flow(const nlohmann::json& point) { return point["flow_l_per_min"].get<double>(); }

  static inline ScratchFolder* folder = nullptr;
  static inline nlohmann::json built;
};

TEST_F(FurtherInputs, AreEmulatedAsTheSceneHasThem) {
  ASSERT_EQ(built["runs"].size(), 34u); // 4 corners of the operating points, 24 inside, 6 held out
  EXPECT_LT(built["held_out"]["rms_l_per_min"], 0.02 * built["flow_range_l_per_min"].get<double>());
  EXPECT_EQ(built["runs"][0]["membrane.young_dyn_per_cm2"], 1.686e7); // corners: as the scene states
  EXPECT_NE(built["runs"][6]["membrane.young_dyn_per_cm2"], 1.686e7);
  for (const std::string young : {"1.55e7", "1.8e7"}) {
    const auto emulated = point("pump.h5", {"--set", "membrane.young_dyn_per_cm2=" + young});
    const auto computed = point(scene, {"--set", "membrane.young_dyn_per_cm2=" + young});
    EXPECT_LT(std::abs(flow(emulated) - flow(computed)), 2 * emulated["error_l_per_min"].get<double>());
    EXPECT_LT(emulated["error_l_per_min"].get<double>(), 0.5);
  }
  const double stated = flow(point("pump.h5", {}));
  EXPECT_NEAR(stated, flow(point("pump.h5", {"--set", "membrane.young_dyn_per_cm2=1.686e7"})), 1e-12);
  EXPECT_GT(std::abs(flow(point("pump.h5", {"--set", "membrane.young_dyn_per_cm2=1.8e7"})) - stated), 0.1);
  EXPECT_FALSE(point("pump.h5", {"--set", "membrane.young_dyn_per_cm2=2e7"})["inside_training_box"]);
  expect_refused(
      {"hq", "pump.h5", "--frequency", "120", "--voltage", "40", "--set", "membrane.young_dyn_per_cm2=x"},
      "value of the key");
  expect_refused({"hq", "pump.h5", "--frequency", "120", "--voltage", "40", "--set", "membrane.poisson=0.4"},
                 "actuator.force_N_per_V, membrane.young_dyn_per_cm2");
}

TEST_F(FurtherInputs, AForcePerVoltScalesTheVoltage) {
  const std::string key = "actuator.force_N_per_V=";
  const double force = 0.42; // of the scene
  const auto scaled = point("pump.h5", {"--set", key + std::to_string(force * 1.1)});
  EXPECT_NEAR(flow(scaled), flow(point("pump.h5", {}, "44")), 1e-9);
  EXPECT_NEAR(flow(scaled), flow(point(scene, {"--set", key + std::to_string(force * 1.1)})), 0.1);
}

TEST_F(FurtherInputs, CalibrationFindsTheModulusThatMadeTheData) {
  {
    std::ofstream data(folder->path() / "data.csv");
    data << "# frequency_Hz: 120\n# voltage_V: 42\nhead_mmHg,flow_l_per_min\n";
    for (const std::string head : {"30", "40", "50", "60"}) {
      const auto answer = json_of({"hq", scene, "--voltage", "42", "--head", head, "--json", "--set",
                                   "membrane.young_dyn_per_cm2=1.6e7"},
                                  *folder);
      data << head << "," << flow(answer["points"][0]) << "\n";
    }
  }
  const Words words = {"calibrate", scene,        "--by",   "pump.h5",
                       "--data",    "data.csv",   "--free", "membrane.young_dyn_per_cm2=1.5e7:1.9e7",
                       "--output",  "found.toml", "--json", "--force"};
  const auto found = json_of(words, *folder);
  EXPECT_NEAR(found["keys"][0]["optimum"].get<double>(), 1.6e7, 1e5);
  Words other = words;
  other.insert(other.end(), {"--set", "membrane.poisson=0.48"});
  expect_refused(other, "of another scene");
  other = words;
  other[7] = "membrane.poisson=0.4:0.49";
  expect_refused(other, "has no such input");
}

/// Outflow 1 + head / 10 plus a sine of as much as the head, a membrane of three places.
void save_known_course(const std::filesystem::path& file) {
  constexpr int runs = 6, phases = 12;
  Eigen::MatrixXd points(1, runs);
  Eigen::VectorXd heads(runs);
  for (int i = 0; i < runs; ++i) {
    points(0, i) = i / (runs - 1.0);
    heads[i] = 10 * points(0, i);
  }
  const rom::ProcessParameters parameters{Eigen::VectorXd::Constant(1, 1), 1, 1e-8};
  const rom::GaussianProcess head(points, heads, Eigen::VectorXd::Zero(runs), parameters);
  rom::Emulator emulator;
  emulator.driven_by_voltage = true;
  emulator.inputs = {{"frequency", "Hz", 120, 120}, {"voltage", "V", 40, 40}, {"head", "mmHg", 0, 10}};
  emulator.quantities.push_back({"flow_l_per_min", "l/min", head, 1});
  rom::EmulatedResponse outflow{"outflow_l_per_min", "l/min", {0}, phases, {}, {}, {head}, 0.1};
  outflow.mean = Eigen::VectorXd::Constant(phases, 1);
  outflow.modes.resize(phases, 1);
  for (int k = 0; k < phases; ++k) {
    outflow.modes(k, 0) = 0.1 + std::sin(2 * std::numbers::pi * k / phases);
  }
  rom::EmulatedResponse membrane{"membrane_mm", "mm", {5, 10, 15}, phases, {}, {}, {}, 0.02};
  membrane.mean = Eigen::VectorXd::LinSpaced(3 * phases, 0, 1);
  membrane.modes.resize(3 * phases, 0);
  emulator.responses = {membrane, outflow};
  rom::save_emulator(emulator, file.string());
}

TEST(PeriodCommand, ShowsTheCourseOfMembraneAndOutflow) {
  const ScratchFolder folder;
  save_known_course(folder.path() / "pump.h5");
  const Words ask = {"period", "pump.h5", "--frequency", "120", "--voltage", "40", "--head", "6"};
  Words json = ask;
  json.insert(json.end(), {"--json", "--plot", "period.png"});
  const auto course = json_of(json, folder);
  EXPECT_EQ(course["head_mmHg"], 6);
  const auto &membrane = course["quantities"][0], &outflow = course["quantities"][1];
  ASSERT_EQ(outflow["values_by_phase"].size(), 12u);
  EXPECT_NEAR(outflow["values_by_phase"][0][0].get<double>(), 1.6, 1e-3);
  EXPECT_NEAR(outflow["values_by_phase"][3][0].get<double>(), 7.6, 1e-3);
  EXPECT_EQ(outflow["error"], 0.1);
  EXPECT_NEAR(membrane["values_by_phase"][2][1].get<double>(), 7.0 / 35, 1e-12);
  EXPECT_EQ(membrane["places_mm"], nlohmann::json({5, 10, 15}));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "period.png"));
  const std::string table = run_undula(ask, folder.path()).out;
  EXPECT_NE(table.find("membrane_mm at 5 mm"), std::string::npos) << table;
  EXPECT_NE(table.find("90.0"), std::string::npos);
  EXPECT_NE(table.find("7.6"), std::string::npos);
  const Outcome outside = run_undula(
      {"period", "pump.h5", "--frequency", "120", "--voltage", "40", "--head", "12"}, folder.path());
  EXPECT_NE(outside.err.find("head 12 mmHg is outside"), std::string::npos) << outside.err;
  const auto refused = [&](const Words& words, const std::string& text) {
    const Outcome outcome = run_undula(words, folder.path());
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
  };
  refused({"period", scene, "--frequency", "120", "--head", "40"}, "computed, not looked up");
  refused(
      {"period", UNDULA_SOURCE_DIR "/data/models/wave_pump_fixed.h5", "--frequency", "120", "--head", "40"},
      "keeps no course");
}

TEST_F(FurtherInputs, HaveNoCourseWhereTheRunsRecordedNone) {
  expect_refused({"period", "pump.h5", "--frequency", "120", "--voltage", "40", "--head", "40"},
                 "recorded no fields");
}

TEST_F(FurtherInputs, AreRefusedWhereTheyMakeNoSense) {
  const auto refused = [&](const std::string& vary, const std::string& text) {
    expect_refused(train_words({"--set", "training.vary=[" + vary + "]"}), text);
    expect_refused(
        {"check", scene, "--set", "training.model=emulator", "--set", "training.vary=[" + vary + "]"}, text);
  };
  refused("\"membrane.young_dyn_per_cm2\"", "cannot be read");
  refused("\"membrane.young=1:2\"", "unknown key");
  refused("\"membrane.young_dyn_per_cm2=1.9e7:1.5e7\"", "no range");
  refused("\"membrane.young_dyn_per_cm2=1.8e7:1.9e7\"", "outside of the range");
  refused("\"membrane.poisson=0.4:0.8\"", "out of range");
  refused("\"operating_point.head_mmHg=40:60\"", "range of its own");
  refused("\"membrane.poisson=0.4:0.495\", \"membrane.poisson=0.4:0.495\"", "varied twice");
  expect_refused({"train", UNDULA_SOURCE_DIR "/data/scenes/wave_pump_mapped_voltage.toml", "--set",
                  R"(training.vary=["membrane.poisson=0.4:0.495"])", "--set", "training.model=projected"},
                 "varies no further keys");
}

} // namespace
} // namespace undula::apps
