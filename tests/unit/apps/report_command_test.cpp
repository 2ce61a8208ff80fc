// undula report: the arithmetic of its table, and the command on a scene, a model and recorded runs.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "apps/apps.hpp"
#include "apps/output/level_report.hpp"
#include "tests/unit/apps/run_undula.hpp"

namespace undula::apps {
namespace {

const std::string root = UNDULA_SOURCE_DIR;
const std::string scene = root + "/data/scenes/wave_pump_thin_gap.toml";
const std::string model = root + "/data/models/wave_pump_fixed.h5";
const std::string runs = root + "/data/models/wave_pump_fixed_runs_120Hz_0.53mm.json";
const std::string data = root + "/data/measured/corwave_120hz_0.53mm.csv";

TEST(LevelReport, DifferenceLeavesOutWhatIsMissing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> a = {1, 2, nan, 4}, b = {1, 5, 3, 0}, nothing(4, nan);
  const CurveDifference difference = curve_difference(a, b);
  EXPECT_EQ(difference.points, 3);
  EXPECT_DOUBLE_EQ(difference.largest, 4);
  EXPECT_DOUBLE_EQ(difference.rms, std::sqrt((0.0 + 9 + 16) / 3));
  EXPECT_TRUE(std::isnan(curve_difference(a, nothing).rms));
}

TEST(LevelReport, TableNamesTheReferenceOfALevel) {
  LevelReport report;
  report.data_file = "data.csv";
  report.head_mmHg = {40, 60};
  report.measured = {3, 1};
  report.results = {{"reduced model", "model.h5", 10, {2, 0}, 0.01, 1},
                    {"full order, recorded", "runs.json", 1000, {2, 1}, 50, -1}};
  const auto json = nlohmann::json::parse(level_report_json(report));
  EXPECT_DOUBLE_EQ(json["levels"][0]["rms_to_data_l_per_min"].get<double>(), 1);
  EXPECT_DOUBLE_EQ(json["levels"][0]["rms_to_reference_l_per_min"].get<double>(), std::sqrt(0.5));
  EXPECT_TRUE(json["levels"][1]["rms_to_reference_l_per_min"].is_null());
  EXPECT_NE(level_report_table(report).find("1 reduced model"), std::string::npos);
}

TEST(ReportCommand, ComparesAllLevelsAndTheirSettings) {
  const ScratchFolder folder;
  const Outcome outcome =
      run_undula({"report", scene, model, runs, "--data", data, "--frequency", "120", "--stroke", "0.53",
                  "--points", "2", "--vary", "time.steps_per_period=24,48", "--plot", "report.png", "--json"},
                 folder.path());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto levels = nlohmann::json::parse(outcome.out)["levels"];
  ASSERT_EQ(levels.size(), 5u);
  const auto rms = [&](int level, const char* key) { return levels[level][key].get<double>(); };
  // The thin gap pumps; on a fixed cut the pump leaks by litres, and its reduced model repeats that.
  EXPECT_LT(rms(0, "rms_to_data_l_per_min"), 2);
  EXPECT_GT(rms(4, "rms_to_data_l_per_min"), 3);
  EXPECT_LT(rms(3, "rms_to_reference_l_per_min"), 0.06);
  EXPECT_EQ(levels[1]["reference"], 2);
  EXPECT_GT(rms(1, "rms_to_reference_l_per_min"), 1e-4); // half the steps do make a difference
  EXPECT_LT(rms(3, "seconds_per_point"), rms(4, "seconds_per_point") / 100);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "report.gp"));
}

TEST(ReportCommand, FindsTheCalibratedSceneAsNearToTheDataAsItsHeaderSays) {
  const std::string calibrated = root + "/data/scenes/wave_pump_thin_gap_calibrated.toml";
  const std::string header = text_of(calibrated);
  const std::string before = "l/min before, ";
  const auto place = header.find(before);
  ASSERT_NE(place, std::string::npos);
  const double stated = std::stod(header.substr(place + before.size()));
  const ScratchFolder folder;
  const Outcome outcome = run_undula({"report", calibrated, "--data", data, "--frequency", "120", "--stroke",
                                      "0.53", "--points", "6", "--json"},
                                     folder.path());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto level = nlohmann::json::parse(outcome.out)["levels"][0];
  // Flows repeat from period to period to some 0.01 l/min.
  EXPECT_NEAR(level["rms_to_data_l_per_min"].get<double>(), stated, 0.02);
  EXPECT_LT(stated, 0.4);
}

TEST(ReportCommand, RefusesRunsOfAnotherOperatingPointAndBadVariations) {
  const ScratchFolder folder;
  const auto refused = [&](const std::vector<std::string>& words, const std::string& text) {
    const Outcome outcome = run_undula(words, folder.path());
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
  };
  refused({"report", runs, "--data", data, "--frequency", "120", "--stroke", "0.63"},
          "another operating point");
  refused(
      {"report", scene, "--data", data, "--frequency", "120", "--stroke", "0.53", "--vary", "thin_gap.cells"},
      "--vary");
  refused({"report", scene, "--data", "missing.csv", "--frequency", "120", "--stroke", "0.53"},
          "missing.csv");
}

} // namespace
} // namespace undula::apps
