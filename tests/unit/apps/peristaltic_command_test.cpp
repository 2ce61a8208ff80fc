// check, solve, hq and train on the shipped peristaltic pump, through the binary.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/apps.hpp"
#include "fom/output/checkpoint.hpp"
#include "fom/output/time_series.hpp"
#include "tests/unit/apps/final_state.hpp"
#include "tests/unit/apps/run_undula.hpp"

namespace undula::apps {
namespace {

using Words = std::vector<std::string>;
using Json = nlohmann::json;

const std::string scene = UNDULA_SOURCE_DIR "/data/scenes/peristaltic_pump.toml";

Outcome run_done(const Words& words, const std::filesystem::path& folder) {
  Outcome outcome = run_undula(words, folder);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return outcome;
}

TEST(PeristalticCommands, CheckSaysWhatFollowsFromTheKeys) {
  const ScratchFolder folder;
  const Json found = Json::parse(run_done({"check", scene, "--json"}, folder.path()).out);
  // by hand: 146 - 15 - 16, 146 - 30 - 4 - 66.25.
  EXPECT_NEAR(found["hose"]["centreline_radius_mm"], 115, 1e-9);
  EXPECT_NEAR(found["hose"]["crank_mm"], 45.75, 1e-9);
  EXPECT_NEAR(found["hose"]["gap_mm"], 4, 1e-9);
  EXPECT_NEAR(found["hose"]["closed_volume_per_turn_ml"].get<double>(), 581 - 63, 1.5);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(PeristalticCommands, SolveLeavesEverythingAndRestartsBitForBit) {
  const ScratchFolder folder;
  const auto solve = [&](const std::string& output, const char* periods, const Words& more) {
    Words words = {"solve",    scene,
                   "--set",    std::string("time.periods=") + periods,
                   "--set",    "time.steps_per_period=48",
                   "--set",    "output.fields_every=24",
                   "--set",    "output.checkpoint_every=40",
                   "--output", output};
    words.insert(words.end(), more.begin(), more.end());
    return run_done(words, folder.path());
  };
  const Outcome through = solve("through", "3", {"--plot", "--json"});
  solve("stopped", "1", {});
  const auto a = folder.path() / "through", b = folder.path() / "stopped";
  std::filesystem::remove(newest_checkpoint(b / "checkpoints").value());
  solve("stopped", "3", {"--restart"});
  EXPECT_EQ(text_of(a / "time_series.csv"), text_of(b / "time_series.csv"));
  for (const char* name :
       {"time_series.csv", "cycle_means.csv", "timing.json", "fluid.xdmf", "solids.xdmf", "speed.png",
        "pressure.png", "flow.png", "torque.png", "outlet_pressure.png", "roller_force.png"})
    EXPECT_TRUE(std::filesystem::exists(a / name)) << name;
  EXPECT_FALSE(std::filesystem::exists(a / "membrane.csv"));
  const Json turn = Json::parse(through.out)["periods"][2];
  EXPECT_NEAR(turn["turn"]["volume_ml"].get<double>(),
              turn["outflow_l_per_min"].get<double>() * 1000 / 60 * 1.1, 1e-6);
  EXPECT_LT(std::abs(turn["energy_gap"].get<double>()), 1e-9);
  // --force takes away what it wrote, and nothing is left over.
  run_done({"solve", scene, "--set", "time.periods=1", "--set", "time.steps_per_period=48", "--output",
            "through", "--force"},
           folder.path());
  EXPECT_FALSE(std::filesystem::exists(a / "torque.png"));
}

TEST(PeristalticCommands, HqFallsWithTheHeadAndSaysWhatTheRollersDo) {
  const ScratchFolder folder;
  const Json curve = Json::parse(run_done({"hq", scene, "--head", "0,10,20", "--set",
                                           "time.steps_per_period=96", "--json", "--plot", "hq.png"},
                                          folder.path())
                                     .out);
  EXPECT_EQ(curve["level"], "long wave");
  EXPECT_FALSE(curve.contains("stroke_mm"));
  double before = 1e9;
  for (const Json& point : curve["points"]) {
    EXPECT_TRUE(point["periodic"].get<bool>());
    EXPECT_LT(point["flow_l_per_min"].get<double>(), before);
    EXPECT_GT(point["rollers"]["torque_N_m"].get<double>(), 0);
    before = point["flow_l_per_min"];
  }
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "hq.png"));
}

TEST(PeristalticCommands, HqTakesABandOfTolerancesAndAnotherHoseBeside) {
  const ScratchFolder folder;
  std::string text = text_of(scene);
  text.replace(text.find("occlusion = 0.875"), 17, "occlusion = 0.95");
  std::ofstream(folder.path() / "tighter.toml") << text;
  const Json curve =
      Json::parse(run_done({"hq", scene, "--head", "0", "--frequency", "0.5", "--beside", "tighter.toml",
                            "--band", "--set", "rollers.occlusion={ value = 0.875, tolerance = 0.02 }",
                            "--set", "time.steps_per_period=48", "--json"},
                           folder.path())
                      .out);
  const Json& point = curve["points"][0];
  EXPECT_EQ(curve["frequency_Hz"], 0.5);
  EXPECT_GT(point["beside"]["flow_l_per_min"].get<double>(), point["flow_l_per_min"].get<double>());
  // The beside one turns at the same speed: its plug is no faster.
  EXPECT_LT(point["beside"]["flow_l_per_min"].get<double>(), 0.581 * 0.5 * 60);
  EXPECT_GT(point["error_l_per_min"].get<double>(), 0.1);
}

TEST(PeristalticCommands, WhatNeedsAWavePumpSaysSo) {
  const ScratchFolder folder;
  for (const Words& words : std::vector<Words>{
           {"train", scene},
           {"calibrate", scene, "--data", UNDULA_SOURCE_DIR "/data/measured/corwave_120hz_0.53mm.csv",
            "--free", "rollers.occlusion=0.5:0.9", "--output", "c.toml"}}) {
    const Outcome outcome = run_undula(words, folder.path());
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_NE(outcome.err.find("needs a scene of a wave pump"), std::string::npos) << outcome.err;
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  }
}

} // namespace
} // namespace undula::apps
