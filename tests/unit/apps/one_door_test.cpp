// Every command on every level: what a scene states is what is computed, or the command refuses.
//
// The reference of every pair is the same one: hq. That hq computes the stated physics is shown against
// solve, which marches the same number of periods.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/apps.hpp"
#include "tests/unit/apps/run_undula.hpp"

namespace undula::apps {
namespace {

using Words = std::vector<std::string>;
using Json = nlohmann::json;

const std::string root = UNDULA_SOURCE_DIR;
const std::string data = root + "/data/measured/corwave_120hz_0.53mm.csv";
const std::string model = root + "/data/models/wave_pump_fixed.h5";

/// A level, and settings coarse enough for a unit test: few elements, few steps, two periods.
struct Case {
  std::string name, scene, level;
  Words settings;
};

void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

std::vector<Case> cases() {
  const Words coarse = {
      "mesh.gap_elements=2",   "mesh.channel_size_mm=2.5",      "mesh.membrane_size_mm=0.8",
      "mesh.growth=0.6",       "time.steps_per_period=16",      "time.periods=2",
      "time.ramp_periods=0.5", "operating_point.stroke_mm=0.2", "training.snapshots_per_period=16"};
  const auto with = [&](const Words& more) {
    Words all = coarse;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  return {{"fixed", "wave_pump_fixed", "full order, fixed", coarse},
          {"explicit", "wave_pump_explicit", "full order, explicit", coarse},
          {"mapped", "wave_pump_mapped", "full order, mapped", with({"operating_point.stroke_mm=0.05"})},
          {"thin_gap", "wave_pump_thin_gap", "thin gap", with({"thin_gap.cells=16"})}};
}

Words on(const std::string& command, const Case& one, const Words& more) {
  Words words = {command, root + "/data/scenes/" + one.scene + ".toml"};
  for (const std::string& setting : one.settings) {
    words.insert(words.end(), {"--set", setting});
  }
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

Json run(const Words& words) {
  const ScratchFolder folder;
  Words all = words;
  all.emplace_back("--json");
  const Outcome outcome = run_undula(all, folder.path());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return outcome.exit_code == 0 ? Json::parse(outcome.out) : Json();
}

void expect_refused(const Words& words, const std::string& text) {
  const ScratchFolder folder;
  const Outcome outcome = run_undula(words, folder.path());
  EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

class OneDoor : public testing::TestWithParam<Case> {};

TEST_P(OneDoor, HqComputesThePhysicsThatSolveComputes) {
  const Json point = run(on("hq", GetParam(), {"--head", "45"}))["points"][0];
  Words words = on("solve", GetParam(), {"--set", "operating_point.head_mmHg=45"});
  const Json periods = run(words)["periods"];
  ASSERT_EQ(periods.size(), 2u);
  // Not periodic after two periods, too few for a mean: the last one counts.
  const double last = periods[1]["outflow_l_per_min"].get<double>();
  ASSERT_GT(std::abs(last), 1e-3);
  EXPECT_NEAR(point["flow_l_per_min"].get<double>(), last, 1e-9 * std::abs(last));
  EXPECT_EQ(point["averaged_periods"], 1);
  EXPECT_EQ(point["periodic"], false);
  EXPECT_NEAR(point["clearance_min_mm"].get<double>(), periods[1]["clearance_min_mm"].get<double>(), 1e-9);
}

TEST_P(OneDoor, ValidateAndReportTakeTheFlowsOfHq) {
  const Json curve = run(on("hq", GetParam(), {"--head", "40,60"}));
  EXPECT_EQ(curve["level"], GetParam().level);
  const auto flow = [&](int i) { return curve["points"][i]["flow_l_per_min"].get<double>(); };

  const Json validated = run(on("validate", GetParam(), {"--head", "40,60", "--data", data}));
  for (int i : {0, 1}) {
    EXPECT_EQ(validated["points"][i]["computed_l_per_min"].get<double>(), flow(i));
  }

  // report takes settings from --vary alone, and the heads from the data.
  const ScratchFolder folder;
  Words words = on("check", GetParam(), {"--json"});
  const Outcome resolved = run_undula(words, folder.path());
  ASSERT_EQ(resolved.exit_code, 0) << resolved.err;
  std::string text = Json::parse(resolved.out)["resolved"].get<std::string>();
  const auto scene = folder.path() / "coarse.toml";
  std::ofstream(scene) << text;
  const Json report = run({"report", scene.string(), "--data", data, "--frequency", "120", "--stroke",
                           GetParam().name == "mapped" ? "0.05" : "0.2", "--points", "2"});
  ASSERT_EQ(report["levels"].size(), 1u);
  EXPECT_EQ(report["levels"][0]["level"], GetParam().level);
  const Json& heads = report["head_mmHg"];
  const Json same = run(on("hq", GetParam(), {"--head", heads[0].dump() + "," + heads[1].dump()}));
  for (int i : {0, 1}) {
    EXPECT_EQ(report["levels"][0]["flow_l_per_min"][i], same["points"][i]["flow_l_per_min"]);
  }
}

TEST_P(OneDoor, TheBandIsThatOfTheSameLevel) {
  Case stiffer = GetParam();
  const std::string key = "fluid.density_g_per_cm3";
  Case tolerant = stiffer;
  for (const char* shipped :
       {"geometry.clearance_scale", "geometry.rim_gap_scale", "operating_point.stroke_scale"}) {
    tolerant.settings.push_back(std::string(shipped) + "={value=1.0,tolerance=0.0}");
  }
  if (GetParam().name == "thin_gap") {
    tolerant.settings.insert(tolerant.settings.end(),
                             {"membrane.young_dyn_per_cm2={value=1.686e7,tolerance=0.0}",
                              "membrane.damping_time_s={value=1e-4,tolerance=0.0}",
                              "thin_gap.film_thickness_mm={value=0.05,tolerance=0.0}"});
    stiffer.settings = tolerant.settings;
  }
  tolerant.settings.push_back(key + "={value=1.0,tolerance=0.1}");
  Case nominal = stiffer;
  nominal.settings.push_back(key + "=1.0");
  stiffer.settings.push_back(key + "=1.1");
  const Json band = run(on("hq", tolerant, {"--head", "45", "--band"}));
  const double flow = run(on("hq", nominal, {"--head", "45"}))["points"][0]["flow_l_per_min"];
  const double end = run(on("hq", stiffer, {"--head", "45"}))["points"][0]["flow_l_per_min"];
  ASSERT_EQ(band["tolerances"].size(), 1u);
  EXPECT_EQ(band["points"][0]["flow_l_per_min"].get<double>(), flow);
  EXPECT_NEAR(band["tolerances"][0]["plus_l_per_min"][0].get<double>(), end - flow, 1e-9);
  EXPECT_NE(end, flow);
}

INSTANTIATE_TEST_SUITE_P(Levels, OneDoor, testing::ValuesIn(cases()),
                         [](const auto& one) { return one.param.name; });

TEST(OneDoorModel, ValidateAndReportTakeTheFlowsOfHq) {
  const Words drive = {"--frequency", "120", "--stroke", "0.53"};
  const auto words = [&](Words begin, const Words& end) {
    begin.insert(begin.end(), drive.begin(), drive.end());
    begin.insert(begin.end(), end.begin(), end.end());
    return begin;
  };
  const Json report = run(words({"report", model, "--data", data}, {"--points", "2"}));
  const Json& heads = report["head_mmHg"];
  const std::string list = heads[0].dump() + "," + heads[1].dump();
  const Json curve = run(words({"hq", model}, {"--head", list}));
  EXPECT_EQ(curve["level"], "reduced model");
  const Json validated = run(words({"validate", model, "--data", data}, {"--head", list}));
  for (int i : {0, 1}) {
    const Json& flow = curve["points"][i]["flow_l_per_min"];
    EXPECT_EQ(report["levels"][0]["flow_l_per_min"][i], flow);
    EXPECT_EQ(validated["points"][i]["computed_l_per_min"], flow);
  }
}

TEST(OneDoorModel, StandsBesideASceneAndASceneBesideIt) {
  const Case thin = cases()[3];
  const Json scene = run(on("hq", thin, {"--head", "45", "--beside", model}));
  EXPECT_EQ(scene["points"][0]["beside"]["level"], "reduced model");
  const Json alone = run({"hq", model, "--frequency", "120", "--stroke", "0.2", "--head", "45"});
  EXPECT_EQ(scene["points"][0]["beside"]["flow_l_per_min"], alone["points"][0]["flow_l_per_min"]);
  const Json reduced = run({"hq", model, "--frequency", "120", "--stroke", "0.2", "--head", "45", "--beside",
                            root + "/data/scenes/wave_pump_thin_gap.toml"});
  EXPECT_EQ(reduced["points"][0]["beside"]["level"], "thin gap");
}

TEST(OneDoorModel, RefusesWhatOnlyASceneStates) {
  const Words drive = {"hq", model, "--frequency", "120", "--stroke", "0.53", "--head", "45"};
  const auto refused = [&](const Words& more, const std::string& text) {
    Words words = drive;
    words.insert(words.end(), more.begin(), more.end());
    expect_refused(words, text);
  };
  refused({"--set", "mesh.gap_elements=2"}, "no keys to override");
  refused({"--band"}, "--band");
  refused({"--", "-log_view"}, "options for PETSc");
}

TEST(OneDoorRefusals, TrainRefusesBeforeTheFirstRunWhatItWouldLeaveOut) {
  const std::string scene = root + "/data/scenes/wave_pump_fixed_training.toml";
  for (const auto& [settings, text] : std::vector<std::pair<Words, std::string>>{
           {{"model.coupling=explicit"}, "coupling"},
           {{"model.coupling=mapped"}, "driven by a voltage"},
           {{"model.solid=neo-hookean"}, "linear operators"},
           {{"contact.film_mm=0.1", "contact.stiffness_dyn_per_cm2=1e4"}, "contact"},
           {{"stabilisation.velocity_scale=local"}, "penalties"},
           {{"stabilisation.weights=derived"}, "penalties"},
           {{"stabilisation.reference_time_s=0"}, "penalties that are the same"},
           {{"operating_point.stroke_scale=1.1"}, "stroke_scale"}}) {
    Words words = {"train", scene};
    for (const std::string& setting : settings) {
      words.insert(words.end(), {"--set", setting});
    }
    expect_refused(words, text);
  }
  expect_refused({"train", root + "/data/scenes/wave_pump_thin_gap.toml"}, "thin-gap");
  expect_refused({"train", root + "/data/scenes/cylinder_2d1.toml"}, "pump");
}

TEST(OneDoorRefusals, CurvesNeedAPump) {
  for (const char* command : {"hq", "validate", "report"}) {
    Words words = {command, root + "/data/scenes/cylinder_2d1.toml"};
    if (std::string(command) != "hq") {
      words.insert(words.end(), {"--data", data});
    }
    if (std::string(command) == "report") {
      words.insert(words.end(), {"--frequency", "120", "--stroke", "0.53"});
    }
    expect_refused(words, "pump");
  }
}

} // namespace
} // namespace undula::apps
