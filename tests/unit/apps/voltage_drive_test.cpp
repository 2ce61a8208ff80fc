// A scene that a voltage drives, through the commands.
#include <gtest/gtest.h>

#include <cmath>
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
