// solve, hq, check, validate and train on the shipped thin-gap scene, through the binary.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/apps.hpp"
#include "fom/output/checkpoint.hpp"
#include "fom/output/time_series.hpp"
#include "rom/base/hdf5_file.hpp"
#include "tests/unit/apps/final_state.hpp"
#include "tests/unit/apps/run_undula.hpp"

namespace undula::apps {
namespace {

using Words = std::vector<std::string>;
using Json = nlohmann::json;

const std::string scene = UNDULA_SOURCE_DIR "/data/scenes/wave_pump_thin_gap.toml";
const std::string data = UNDULA_SOURCE_DIR "/data/measured/corwave_120hz_0.53mm.csv";

Words on_scene(const std::string& command, const Words& settings, const Words& more = {}) {
  Words words = {command, scene};
  for (const std::string& setting : settings) {
    words.insert(words.end(), {"--set", setting});
  }
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

Outcome run_done(const Words& words, const std::filesystem::path& folder) {
  Outcome outcome = run_undula(words, folder);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return outcome;
}

void expect_refused(const Outcome& outcome, const std::string& text) {
  EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
}

TEST(ThinGapSolve, LeavesEverythingAndRestartsBitForBit) {
  const ScratchFolder folder;
  const auto solve = [&](const std::string& output, const char* periods, const Words& more) {
    Words words = on_scene(
        "solve",
        {std::string("time.periods=") + periods, "output.fields_every=48", "output.checkpoint_every=40"},
        {"--output", output});
    words.insert(words.end(), more.begin(), more.end());
    return run_done(words, folder.path());
  };
  solve("through", "3", {"--plot"});
  solve("stopped", "1", {});
  const auto a = folder.path() / "through", b = folder.path() / "stopped";
  // As if killed before the end of the period: goes on from step 40.
  std::filesystem::remove(newest_checkpoint(b / "checkpoints").value());
  solve("stopped", "3", {"--restart"});
  for (const char* name : {"time_series.csv", "membrane.csv", "cycle_means.csv", "envelope.csv"}) {
    EXPECT_FALSE(text_of(a / name).empty()) << name;
    EXPECT_EQ(text_of(a / name), text_of(b / name)) << name;
  }
  for (const auto& [file, field] :
       {std::pair("fluid_192.h5", "fields/velocity"), std::pair("fluid_48.h5", "fields/pressure"),
        std::pair("solids_192.h5", "fields/displacement")}) {
    const auto through = Hdf5File::open_read(a / file).read<double>(field);
    EXPECT_GT(*std::max_element(through.begin(), through.end()), 0) << file;
    EXPECT_EQ(through, Hdf5File::open_read(b / file).read<double>(field)) << file;
  }
  for (const char* index : {"fluid.xdmf", "solids.xdmf"}) {
    EXPECT_EQ(occurrences(text_of(b / index), "<Time "), 4) << index;
  }
  EXPECT_EQ(final_state(a), final_state(b));
  for (const char* name : {"speed.png", "pressure.png", "membrane.png", "flow.png"}) {
    EXPECT_TRUE(text_of(a / name).starts_with("\x89PNG")) << name;
  }
}

TEST(ThinGapSolve, TwoRanksGiveTheSameRun) {
  const ScratchFolder folder;
  const Words words = on_scene("solve", {"time.periods=1"}, {"--output"});
  Words one = words;
  one.push_back("one");
  run_done(one, folder.path());
  std::string command = "cd '" + folder.path().string() +
                        "' && mpirun --allow-run-as-root --oversubscribe --bind-to none -np 2 " UNDULA_BINARY;
  for (const std::string& word : words) {
    command += " '" + word + "'";
  }
  ASSERT_EQ(std::system((command + " two >out.txt 2>err.txt").c_str()), 0)
      << text_of(folder.path() / "err.txt");
  EXPECT_EQ(occurrences(text_of(folder.path() / "out.txt"), "outflow (l/min)"), 1);
  EXPECT_EQ(text_of(folder.path() / "one" / "time_series.csv"),
            text_of(folder.path() / "two" / "time_series.csv"));
}

TEST(ThinGapHq, ThePumpPumpsAndThePassivePumpLeaks) {
  const ScratchFolder folder;
  const auto curve = [&](const Words& settings, const std::string& heads) {
    return Json::parse(run_done(on_scene("hq", settings, {"--head", heads, "--json"}), folder.path()).out);
  };
  const Json driven = curve({}, "60,40,50");
  ASSERT_EQ(driven["points"].size(), 3u);
  EXPECT_EQ(driven["points"][0]["head_mmHg"], 60.0); // in the order asked
  EXPECT_EQ(driven["points"][1]["head_mmHg"], 40.0);
  const Json passive = curve({"operating_point.stroke_mm=0"}, "40")["points"][0];
  EXPECT_LT(passive["flow_l_per_min"].get<double>(), -0.01);
  const Json at_40 = driven["points"][1];
  const double flow = at_40["flow_l_per_min"];
  EXPECT_GT(flow, 0.01);
  EXPECT_LT(driven["points"][0]["flow_l_per_min"].get<double>(), flow);
  EXPECT_GT(at_40["holder_power_mW"].get<double>(), at_40["hydraulic_power_mW"].get<double>());
  EXPECT_TRUE(at_40["error_l_per_min"].is_null());
  for (const Json& point : {passive, at_40}) {
    const double out = point["flow_l_per_min"], in = point["inflow_l_per_min"];
    const double spread = point["spread_l_per_min"];
    // Volume that stays inside shows as a mean over a period only while the state still settles.
    EXPECT_NEAR(in, out, 0.01 * std::abs(out) + spread);
  }
}

TEST(ThinGapHq, IsTheRunThatSolveMakes) {
  const ScratchFolder folder;
  const Json curve =
      Json::parse(run_done(on_scene("hq", {}, {"--head", "30,45", "--json"}), folder.path()).out);
  const Json point = curve["points"][1];
  // From rest, and long enough to forget the start.
  const Json run =
      Json::parse(run_done(on_scene("solve", {"time.periods=30", "operating_point.head_mmHg=45"}, {"--json"}),
                           folder.path())
                      .out);
  double mean = 0, low = 1e9, high = -1e9;
  for (std::size_t i = 20; i < 30; ++i) {
    const double flow = run["periods"][i]["outflow_l_per_min"];
    mean += flow / 10;
    low = std::min(low, flow);
    high = std::max(high, flow);
  }
  const double tolerance = 0.02 * std::abs(mean) + (high - low) + point["spread_l_per_min"].get<double>();
  EXPECT_NEAR(point["flow_l_per_min"].get<double>(), mean, tolerance);
}

TEST(ThinGapHq, CoversTheBoxComparesWithDataAndDraws) {
  const ScratchFolder folder;
  const Outcome outcome = run_done(on_scene("hq", {"training.head_low_mmHg=40", "training.head_high_mmHg=62"},
                                            {"--data", data, "--plot", "curve.png"}),
                                   folder.path());
  EXPECT_EQ(occurrences(outcome.out, "\n"), 13) << outcome.out;
  EXPECT_NE(outcome.out.find("40.00"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("62.00"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("measured, fit (l/min)"), std::string::npos) << outcome.out;
  EXPECT_TRUE(text_of(folder.path() / "curve.png").starts_with("\x89PNG"));
  EXPECT_NE(text_of(folder.path() / "curve.gp").find("measured"), std::string::npos);
}

TEST(ThinGapCheck, PrintsTheCoefficients) {
  const ScratchFolder folder;
  const Json json = Json::parse(run_done(on_scene("check", {}, {"--json"}), folder.path()).out);
  const Json& gap = json["thin_gap"];
  EXPECT_GT(gap["radius_mm"].size(), 8u);
  EXPECT_EQ(gap["radius_mm"].size(), gap["lower_height_mm"].size());
  for (const Json& height : gap["lower_height_mm"]) {
    EXPECT_GT(height.get<double>(), 0);
  }
  ASSERT_EQ(gap["passages"].size(), 3u);
  for (const Json& passage : gap["passages"]) {
    EXPECT_GT(passage["area_cm2"].get<double>(), 0) << passage["name"];
    EXPECT_GT(passage["inertance_per_cm"].get<double>(), 0) << passage["name"];
  }
  const Outcome text = run_done(on_scene("check", {}), folder.path());
  for (const char* word : {"tip", "lip", "rim", "inertance", "outlet", "is valid"}) {
    EXPECT_NE(text.out.find(word), std::string::npos) << word;
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(ThinGapValidate, ComparesTheCurveThatHqComputes) {
  const ScratchFolder folder;
  const Words at_heads = {"--head", "50,55", "--data", data, "--json"};
  const Json validated = Json::parse(run_done(on_scene("validate", {}, at_heads), folder.path()).out);
  const Json curve = Json::parse(run_done(on_scene("hq", {}, at_heads), folder.path()).out);
  ASSERT_EQ(validated["points"].size(), 2u);
  for (int i : {0, 1}) {
    EXPECT_EQ(validated["points"][i]["computed_l_per_min"], curve["points"][i]["flow_l_per_min"]);
    EXPECT_EQ(validated["points"][i]["fit_l_per_min"], curve["points"][i]["measured_l_per_min"]);
  }
}

TEST(ThinGapInput, WhatDoesNotGoTogetherIsRefused) {
  const ScratchFolder folder;
  expect_refused(run_undula(on_scene("train", {}), folder.path()), "undula hq");
  expect_refused(run_undula(on_scene("solve", {"model.coupling=fixed"}), folder.path()), "coupling");
  expect_refused(run_undula(on_scene("hq", {"thin_gap.cells=2"}), folder.path()), "thin_gap.cells");
  expect_refused(run_undula(on_scene("hq", {}, {"--head", "40:62"}), folder.path()), "--head");
  expect_refused(run_undula(on_scene("hq", {}, {"--data", "no.csv"}), folder.path()), "no.csv");
  expect_refused(run_undula(on_scene("hq", {}, {"--plot", "curve.pdf"}), folder.path()), "curve.pdf");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

} // namespace
} // namespace undula::apps
