// undula hq and undula validate through the binary, on a small model.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "rom/curve/hq_curve.hpp"
#include "tests/unit/apps/run_undula.hpp"
#include "tests/unit/apps/test_model.hpp"

namespace undula::apps {
namespace {

const std::string data = UNDULA_SOURCE_DIR "/data/measured/corwave_120hz_0.53mm.csv";

bool is_png(const std::filesystem::path& file) { return text_of(file).starts_with("\x89PNG\r\n\x1a\n"); }

TEST(HqCommand, JsonHoldsWhatTheLibraryAnswers) {
  const ScratchFolder folder;
  const auto model = write_small_model(folder.path());
  const Outcome outcome = run_undula(
      {"hq", model.string(), "--frequency", "120", "--stroke", "0.5", "--head", "40:60:10", "--json"},
      folder.path());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const auto json = nlohmann::json::parse(outcome.out);
  const std::vector<double> heads = {40, 50, 60};
  const auto expected = rom::hq_curve(small_model(), 120, 0.5, heads);
  ASSERT_EQ(json["points"].size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& point = json["points"][i];
    EXPECT_EQ(point["head_mmHg"], heads[i]);
    EXPECT_NEAR(point["flow_l_per_min"].get<double>(), expected[i].flow_l_per_min, 1e-9);
    EXPECT_NEAR(point["error_l_per_min"].get<double>(), expected[i].error_l_per_min, 1e-9);
    EXPECT_EQ(point["inside_training_box"], true);
  }
  EXPECT_NE(json["points"][0]["flow_l_per_min"], json["points"][2]["flow_l_per_min"]);
}

TEST(HqCommand, OutsideTheTrainingBoxItWarnsAndSaysSo) {
  const ScratchFolder folder;
  const auto model = write_small_model(folder.path());
  const Outcome outcome =
      run_undula({"hq", model.string(), "--frequency", "120", "--stroke", "0.5", "--head", "50,80", "--json"},
                 folder.path());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("head"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("80"), std::string::npos) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["points"][0]["inside_training_box"], true);
  EXPECT_EQ(json["points"][1]["inside_training_box"], false);
}

TEST(HqCommand, WithoutHeadsItCoversTheTrainingBox) {
  const ScratchFolder folder;
  const auto model = write_small_model(folder.path());
  const Outcome outcome =
      run_undula({"hq", model.string(), "--frequency", "120", "--stroke", "0.5", "--json"}, folder.path());
  const auto json = nlohmann::json::parse(outcome.out);
  ASSERT_EQ(json["points"].size(), 12u);
  EXPECT_EQ(json["points"][0]["head_mmHg"], 0.0);
  EXPECT_EQ(json["points"][11]["head_mmHg"], 70.0);
}

TEST(HqCommand, TableShowsTheMeasuredFitAndThePictureIsDrawn) {
  const ScratchFolder folder;
  const auto model = write_small_model(folder.path());
  const Outcome outcome = run_undula({"hq", model.string(), "--frequency", "120", "--stroke", "0.5", "--head",
                                      "30,50", "--data", data, "--plot", "curve.png"},
                                     folder.path());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(occurrences(outcome.out, "\n"), 3) << outcome.out;
  EXPECT_NE(outcome.out.find("measured, fit (l/min)"), std::string::npos);
  EXPECT_NE(outcome.out.find("1.895\n"), std::string::npos) << outcome.out; // the fit at 50 mmHg
  EXPECT_NE(outcome.out.find("-\n"), std::string::npos) << outcome.out;     // no data at 30 mmHg
  EXPECT_TRUE(is_png(folder.path() / "curve.png"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "curve.png.tmp"));
}

TEST(ValidateCommand, ReportsThePointsAndTheNorm) {
  const ScratchFolder folder;
  const auto model = write_small_model(folder.path());
  const Outcome outcome =
      run_undula({"validate", model.string(), "--frequency", "120", "--stroke", "0.5", "--head", "50,55,60",
                  "--data", data, "--json", "--plot", "validation.png"},
                 folder.path());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  double sum = 0;
  ASSERT_EQ(json["points"].size(), 3u);
  for (const auto& point : json["points"]) {
    sum += std::pow(point["computed_l_per_min"].get<double>() - point["fit_l_per_min"].get<double>(), 2);
  }
  EXPECT_GT(sum, 0);
  EXPECT_NEAR(json["norm_to_fit_l_per_min"].get<double>(), std::sqrt(sum), 1e-12);
  const std::vector<double> heads = {55};
  EXPECT_NEAR(json["points"][1]["computed_l_per_min"].get<double>(),
              rom::hq_curve(small_model(), 120, 0.5, heads)[0].flow_l_per_min, 1e-9);
  EXPECT_TRUE(is_png(folder.path() / "validation.png"));
}

TEST(CheckCommand, TheShippedSceneIsValid) {
  const ScratchFolder folder;
  const Outcome outcome = run_undula({"check", UNDULA_SOURCE_DIR "/data/scenes/wave_pump_fixed.toml", "--set",
                                      "mesh.gap_elements=2", "--json"},
                                     folder.path());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["scene"], "wave_pump_fixed");
  EXPECT_GT(json["meshes"][0]["cells"].get<int>(), 100);
  EXPECT_NE(json["resolved"].get<std::string>().find("gap_elements = 2.0"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

} // namespace
} // namespace undula::apps
