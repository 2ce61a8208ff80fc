// undula calibrate through the binary.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/apps.hpp"
#include "fom/scene/scene_file.hpp"
#include "fom/scene/scene_value.hpp"
#include "tests/unit/apps/run_undula.hpp"

namespace undula::apps {
namespace {

using Words = std::vector<std::string>;

const std::string scene = UNDULA_SOURCE_DIR "/data/scenes/wave_pump_thin_gap.toml";
const std::string data = UNDULA_SOURCE_DIR "/data/measured/corwave_120hz_0.53mm.csv";
const Words coarse = {"--set", "mesh.channel_size_mm=3", "--set", "mesh.gap_elements=2",
                      "--set", "thin_gap.cells=16",      "--set", "time.steps_per_period=24",
                      "--set", "time.periods=30"};

Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST(CalibrateCommand, WritesASceneThatGivesTheReportedCurve) {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder.path() / "scenes");
  const Words words = Words{"calibrate", scene,
                            "--data",    data,
                            "--free",    "operating_point.stroke_scale=0.9:1.3",
                            "--points",  "3",
                            "--output",  "scenes/calibrated.toml",
                            "--json",    "--plot",
                            "fit.png"} +
                      coarse;
  const Outcome outcome = run_undula(words, folder.path());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const auto json = nlohmann::json::parse(outcome.out);
  const auto& curve = json.at("curves").at(0);
  EXPECT_EQ(curve.at("stroke_mm"), 0.53); // as the file states
  EXPECT_LT(curve.at("rms_after_l_per_min").get<double>(), curve.at("rms_before_l_per_min").get<double>());
  EXPECT_NEAR(curve.at("scatter_l_per_min").get<double>(), 0.095, 5e-4);
  const double optimum = json.at("keys").at(0).at("optimum").get<double>();
  EXPECT_GT(optimum, 1); // the uncalibrated pump delivers too little
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "fit.gp"));

  const auto written = folder.path() / "scenes" / "calibrated.toml";
  const std::string text = text_of(written);
  EXPECT_NE(text.find("# data: corwave_120hz_0.53mm.csv"), std::string::npos);
  EXPECT_NE(text.find("# free: operating_point.stroke_scale in 0.9 to 1.3"), std::string::npos);
  EXPECT_NE(text.find("profile = \"../"), std::string::npos); // relative to its folder
  EXPECT_EQ(surface_value(read_scene(written), "operating_point.stroke_scale"), optimum);

  const auto heads = curve.at("head_mmHg").get<std::vector<double>>();
  const std::string head_list =
      std::to_string(heads[0]) + "," + std::to_string(heads[1]) + "," + std::to_string(heads[2]);
  const Outcome hq = run_undula({"hq", written.string(), "--head", head_list, "--json"}, folder.path());
  ASSERT_EQ(hq.exit_code, 0) << hq.err;
  const auto points = nlohmann::json::parse(hq.out).at("points");
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(points.at(i).at("flow_l_per_min").get<double>(),
                curve.at("optimum_l_per_min").at(i).get<double>(), 1e-3);
  }

  const Outcome again = run_undula(words, folder.path());
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_NE(again.err.find("--force"), std::string::npos);
  EXPECT_EQ(text_of(written), text);
}

TEST(CalibrateCommand, WrongInputExitsWithTwoAndWritesNothing) {
  const ScratchFolder folder;
  std::ofstream(folder.path() / "bare.csv") << "head_mmHg,flow_l_per_min\n40,3\n50,2\n60,1\n";
  const auto call = [&](const Words& words) {
    return Words{"calibrate", scene, "--output", "out.toml"} + words;
  };
  const std::string good = "geometry.rim_gap_scale=0.8:1.2";
  const std::vector<std::pair<Words, std::string>> cases = {
      {call({"--data", data, "--free", "geometry.rim_gap_scal=0.8:1.2"}), "geometry.rim_gap_scale"},
      {call({"--data", data, "--free", "geometry.rim_gap_scale=1.2:0.8"}), "low < high"},
      {call({"--data", data, "--free", "geometry.rim_gap_scale=0.8"}), "low:high"},
      {call({"--data", data, "--free", "geometry.rim_gap_scale=0.01:1.2"}), "out of range"},
      {call({"--data", data, "--free", "geometry.rim_gap_scale=1.1:1.2"}), "outside its range"},
      {call({"--data", data, "--free", "thin_gap.cells=16:32"}), "holds no real number"},
      {call({"--data", data, "--free", "operating_point.stroke_mm=0.4:0.6"}), "stated by the data"},
      {call({"--data", data, "--free", good, "--free", good}), "given twice"},
      {call({"--data", "missing.csv", "--free", good}), "missing.csv"},
      {call({"--data", "bare.csv", "--free", good}), "# frequency_Hz"},
      {call({"--data", "bare.csv", "--frequency", "120", "--free", good}), "# stroke_mm"},
      {call({"--data", data, "--data", data, "--stroke", "0.5", "--free", good}), "several data files"},
      {call({"--data", data}), "--free"},
      {call({"--free", good}), "--data"},
      {{"calibrate", scene, "--data", data, "--free", good, "--output", "no_folder/out.toml"}, "--output"},
      {{"calibrate", scene, "--data", data, "--free", good, "--output", "out.txt"}, "--output"}};
  for (const auto& [words, expected] : cases) {
    const Outcome outcome = run_undula(words, folder.path());
    EXPECT_EQ(outcome.exit_code, 2) << expected;
    EXPECT_EQ(outcome.out, "");
    EXPECT_NE(outcome.err.find(expected), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "out.toml"));
  }
}

} // namespace
} // namespace undula::apps
