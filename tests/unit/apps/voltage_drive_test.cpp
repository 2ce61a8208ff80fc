// A scene that a voltage drives, through the commands.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/apps.hpp"
#include "fom/output/time_series.hpp"
#include "tests/unit/apps/run_undula.hpp"

namespace undula::apps {
namespace {

using Words = std::vector<std::string>;

const std::string root = UNDULA_SOURCE_DIR;
const std::string scene = root + "/data/scenes/wave_pump_voltage.toml";
const std::string thin_gap = root + "/data/scenes/wave_pump_thin_gap.toml";

Words with(Words words, const Words& settings) {
  for (const std::string& setting : settings) {
    words.insert(words.end(), {"--set", setting});
  }
  return words;
}

void expect_refused(const Words& words, const std::string& text) {
  const ScratchFolder folder;
  const Outcome outcome = run_undula(words, folder.path());
  EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
  EXPECT_NE(outcome.err.find(text), std::string::npos) << "no \"" << text << "\" in\n" << outcome.err;
}

TEST(VoltageDriveCommands, ARestartRepeatsTheRunBitForBit) {
  const ScratchFolder folder;
  ASSERT_EQ(
      run_undula(with({"solve", scene, "--output", "whole"}, {"time.periods=2"}), folder.path()).exit_code,
      0);
  ASSERT_EQ(
      run_undula(with({"solve", scene, "--output", "parts"}, {"time.periods=1"}), folder.path()).exit_code,
      0);
  ASSERT_EQ(
      run_undula(with({"solve", scene, "--output", "parts", "--restart"}, {"time.periods=2"}), folder.path())
          .exit_code,
      0);
  EXPECT_EQ(text_of(folder.path() / "whole" / "time_series.csv"),
            text_of(folder.path() / "parts" / "time_series.csv"));
}

// The same on finite elements: a coarse pump.
TEST(VoltageDriveCommands, ARestartOfFiniteElementsRepeatsTheRun) {
  const ScratchFolder folder;
  const Words coarse = {
      "operating_point.drive=voltage", "operating_point.voltage_V=40",    "actuator.force_N_per_V=0.4",
      "actuator.moving_mass_g=9.65",   "actuator.suspension_N_per_mm=24", "mesh.gap_elements=2",
      "mesh.channel_size_mm=2",        "mesh.membrane_size_mm=1",         "time.steps_per_period=12"};
  const auto solve = [&](const std::string& output, const std::string& periods, bool restart) {
    Words words = {"solve", root + "/data/scenes/wave_pump_fixed.toml", "--output", output};
    if (restart) {
      words.push_back("--restart");
    }
    Words settings = coarse;
    settings.push_back("time.periods=" + periods);
    const Outcome outcome = run_undula(with(words, settings), folder.path());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  };
  solve("whole", "2", false);
  solve("parts", "1", false);
  solve("parts", "2", true);
  const std::string whole = text_of(folder.path() / "whole" / "time_series.csv");
  EXPECT_EQ(whole, text_of(folder.path() / "parts" / "time_series.csv"));
  EXPECT_NE(whole.find("holder_force_N"), std::string::npos);
}

// Two curves in one call, each beside its own data; data narrow their bands, by the linear law and by draws.
TEST(VoltageDriveCommands, SeveralCurvesInOneCallAndTheirBandsNarrowedByData) {
  const ScratchFolder folder;
  const std::string at_40 = root + "/data/measured/corwave_120hz_0.53mm.csv",
                    at_45 = root + "/data/measured/corwave_120hz_0.63mm.csv";
  const Words ask = with({"hq", scene, "--voltage", "40,45", "--head", "50", "--data", at_45, "--data", at_40,
                          "--plot", "two.png", "--json", "--band"},
                         {"thin_gap.cells=24", "time.steps_per_period=48"});
  const auto curves_of = [&](const Words& more) {
    Words words = ask;
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run_undula(words, folder.path());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out).at("curves");
  };
  const auto wide = curves_of({}), narrow = curves_of({"--given", at_40}),
             drawn = curves_of({"--given", at_40, "--draws", "2"});
  ASSERT_EQ(wide.size(), 2u);
  EXPECT_EQ(wide[0].at("voltage_V"), 40);
  EXPECT_EQ(wide[1].at("voltage_V"), 45);
  const auto point = [](const nlohmann::json& curves, int curve) {
    return curves.at(curve).at("points").at(0);
  };
  EXPECT_NEAR(point(wide, 0).at("measured_l_per_min").get<double>(), 1.90, 0.02);
  EXPECT_NEAR(point(wide, 1).at("measured_l_per_min").get<double>(), 2.98, 0.02);
  for (const int curve : {0, 1}) {
    const double before = point(wide, curve).at("error_l_per_min"),
                 after = point(narrow, curve).at("error_l_per_min");
    EXPECT_EQ(point(wide, curve).at("flow_l_per_min"), point(narrow, curve).at("flow_l_per_min"));
    EXPECT_LT(after, 0.5 * before);
    EXPECT_GT(point(narrow, curve).at("error_of_samples_l_per_min").get<double>(), after);
    EXPECT_NE(point(drawn, curve).at("error_l_per_min"), point(narrow, curve).at("error_l_per_min"));
  }
  EXPECT_EQ(narrow[0].at("given_data").at("inputs").size(), 5u);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "two.png"));

  expect_refused({"hq", scene, "--head", "50", "--given", at_40}, "narrow a band");
  expect_refused({"hq", scene, "--head", "50", "--band", "--draws", "3"}, "--given");
}

TEST(VoltageDriveCommands, AFitHeldByTolerancesAndItsProfile) {
  const ScratchFolder folder;
  const Words words =
      with({"calibrate", scene, "--data", root + "/data/measured/corwave_120hz_0.53mm.csv", "--free",
            "actuator.force_N_per_V=0.3:0.5", "--tolerances", "--points", "2", "--profile",
            "membrane.damping_time_s=0.5e-4:1.5e-4:2", "--output", "fit.toml", "--json"},
           {"thin_gap.cells=24", "time.steps_per_period=48"});
  const Outcome outcome = run_undula(words, folder.path());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  ASSERT_EQ(json.at("keys").size(), 6u);
  EXPECT_LT(json.at("curves").at(0).at("rms_after_l_per_min").get<double>(), 0.05);
  // Two flows are met by one key: the others stay near where the tolerances hold them.
  EXPECT_LT(json.at("misfit").get<double>(), 1);
  const auto& points = json.at("profiles").at(0).at("points");
  ASSERT_EQ(points.size(), 2u);
  EXPECT_LT(points.at(0).at("misfit").get<double>(), 1); // two flows do not tell the damping
  EXPECT_EQ(points.at(0).at("others").size(), 5u);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "fit.toml"));
  expect_refused(
      {"calibrate", scene, "--data", root + "/data/measured/corwave_120hz_0.53mm.csv", "--output", "c.toml"},
      "nothing is free");
  expect_refused({"calibrate", scene, "--data", root + "/data/measured/corwave_120hz_0.53mm.csv",
                  "--tolerances", "--profile", "actuator.force_N_per_V=0.3:0.5:3", "--output", "c.toml"},
                 "one fitted key among others");
}

// The stroke that a curve reports is half of what the holder goes in `solve`, but for its harmonics.
TEST(VoltageDriveCommands, ACurveAndARunSayTheSame) {
  const ScratchFolder folder;
  const Words settings = {"time.periods=8"};
  const Outcome curve =
      run_undula(with({"hq", scene, "--voltage", "45", "--head", "50", "--json"}, settings), folder.path());
  ASSERT_EQ(curve.exit_code, 0) << curve.err;
  const auto json = nlohmann::json::parse(curve.out);
  EXPECT_EQ(json.at("voltage_V"), 45);
  EXPECT_FALSE(json.contains("stroke_mm"));
  const auto& point = json.at("points").at(0);
  const Outcome run = run_undula(
      with({"solve", scene, "--output", "run"}, {"time.periods=8", "operating_point.voltage_V=45"}),
      folder.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const TimeSeries table = read_time_series(folder.path() / "run" / "time_series.csv");
  const auto column = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(table.columns.begin(), table.columns.end(), name) -
                                    table.columns.begin());
  };
  double outflow = 0, low = 1e9, high = -1e9;
  for (std::size_t row = table.rows() - 72; row < table.rows(); ++row) {
    outflow += table.value(row, column("outflow_l_per_min")) / 72;
    low = std::min(low, table.value(row, column("holder_displacement_mm")));
    high = std::max(high, table.value(row, column("holder_displacement_mm")));
  }
  EXPECT_NEAR(point.at("flow_l_per_min").get<double>(), outflow, 0.02);
  EXPECT_NEAR(point.at("holder").at("stroke_mm").get<double>(), (high - low) / 2, 0.01);
  EXPECT_GT(point.at("holder").at("reaction_quadrature_N_per_mm").get<double>(), 15);
}

TEST(VoltageDriveCommands, WhatCannotBeDrivenIsRefused) {
  expect_refused({"hq", root + "/data/scenes/wave_pump_fixed.toml", "--voltage", "40", "--head", "50"},
                 "makes no force");
  expect_refused(with({"train", root + "/data/scenes/wave_pump_fixed_training.toml", "--output", "m.h5"},
                      {"operating_point.drive=voltage", "operating_point.voltage_V=40",
                       "actuator.force_N_per_V=0.4", "actuator.suspension_N_per_mm=20"}),
                 "driven by a stroke");
  expect_refused({"hq", scene, "--voltage", "40,x", "--head", "50"}, "list of voltages");
  expect_refused({"hq", root + "/data/models/wave_pump_fixed.h5", "--frequency", "120", "--voltage", "40"},
                 "driven by a stroke");
  expect_refused({"hq", thin_gap, "--voltage", "40", "--head", "50"}, "makes no force");
  expect_refused({"hq", thin_gap, "--voltage", "40", "--stroke", "0.5", "--head", "50"}, "--stroke");
  expect_refused(with({"check", scene}, {"actuator.suspension_N_per_mm=0"}), "back to its place");
  expect_refused(with({"check", scene}, {"actuator.stop_mm=0.5"}), "by half");
  expect_refused(with({"check", thin_gap}, {"operating_point.drive=voltage", "actuator.force_N_per_V=0.4"}),
                 "none is stated");
  expect_refused({"calibrate", scene, "--data", root + "/data/measured/corwave_120hz_0.53mm.csv", "--stroke",
                  "0.5", "--free", "actuator.force_N_per_V=0.3:0.5", "--output", "c.toml"},
                 "a voltage drives the scene");
  expect_refused({"calibrate", thin_gap, "--data", root + "/data/measured/corwave_120hz_0.53mm.csv",
                  "--voltage", "40", "--free", "geometry.rim_gap_scale=0.8:1.2", "--output", "c.toml"},
                 "a stroke drives the scene");
}

} // namespace
} // namespace undula::apps
