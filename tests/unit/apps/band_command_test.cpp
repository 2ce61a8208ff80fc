// undula hq SCENE --band through the binary, on a coarse pump.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/unit/apps/run_undula.hpp"

namespace undula::apps {
namespace {

using Words = std::vector<std::string>;
using Json = nlohmann::json;

const std::string scene = UNDULA_SOURCE_DIR "/data/scenes/wave_pump_thin_gap.toml";

/// `undula hq` on few cells and steps, with tolerances of the stroke and of the clearance alone.
Words coarse_hq(double stroke_tolerance) {
  Words words = {"hq", scene, "--head", "55,40"};
  for (const std::string& text :
       {std::string("mesh.channel_size_mm=3"), std::string("mesh.gap_elements=2"),
        std::string("thin_gap.cells=16"), std::string("time.steps_per_period=24"),
        std::string("time.periods=30"), std::string("training.periodic_tolerance=5e-4"),
        std::string("geometry.clearance_scale={value=1.0,tolerance=0.02}"),
        std::string("geometry.rim_gap_scale={value=1.0,tolerance=0.0}"),
        std::string("membrane.young_dyn_per_cm2={value=1.686e7,tolerance=0.0}"),
        std::string("membrane.damping_time_s={value=1e-4,tolerance=0.0}"),
        std::string("thin_gap.film_thickness_mm={value=0.05,tolerance=0.0}"),
        "operating_point.stroke_scale={value=1.0,tolerance=" + std::to_string(stroke_tolerance) + "}"}) {
    words.insert(words.end(), {"--set", text});
  }
  return words;
}

Json run(Words words, const std::filesystem::path& folder) {
  words.emplace_back("--json");
  const Outcome outcome = run_undula(words, folder);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return Json::parse(outcome.out);
}

TEST(BandCommand, IsTheRootSumOfSquaresOfTheCurvesAtTheEnds) {
  const ScratchFolder folder;
  Words words = coarse_hq(0.02);
  words.insert(words.end(), {"--band", "--plot", "band.png"});
  const Json band = run(words, folder.path());
  const Json& inputs = band.at("tolerances");
  ASSERT_EQ(inputs.size(), 2u);
  EXPECT_EQ(inputs[0].at("key"), "geometry.clearance_scale");
  EXPECT_EQ(inputs[1].at("key"), "operating_point.stroke_scale");

  // The curve at one end, computed by the same command on its own.
  Words longer = coarse_hq(0);
  longer.insert(longer.end(), {"--set", "operating_point.stroke_scale=1.02"});
  const Json end = run(longer, folder.path());
  for (std::size_t i = 0; i < 2; ++i) {
    const Json& point = band.at("points")[i];
    const double flow = point.at("flow_l_per_min");
    const double up = inputs[1].at("plus_l_per_min")[i], down = inputs[1].at("minus_l_per_min")[i];
    EXPECT_NEAR(up, end.at("points")[i].at("flow_l_per_min").get<double>() - flow, 1e-9);
    EXPECT_GT(up, 0.02); // a longer stroke pumps more
    EXPECT_LT(down, -0.02);
    const double other =
        inputs[0].at("plus_l_per_min")[i].get<double>() - inputs[0].at("minus_l_per_min")[i].get<double>();
    EXPECT_NEAR(point.at("error_l_per_min").get<double>(), std::hypot((up - down) / 2, other / 2), 1e-9);
  }
  EXPECT_NE(text_of(folder.path() / "band.dat").find("# band"), std::string::npos);
}

TEST(BandCommand, TheTableNamesEveryInput) {
  const ScratchFolder folder;
  Words words = coarse_hq(0.02);
  words.emplace_back("--band");
  const Outcome outcome = run_undula(words, folder.path());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* text : {"by tolerances (l/min)", "-+0.", "operating_point.stroke_scale",
                           "geometry.clearance_scale", "+/- at 40 mmHg", "+/- at 55 mmHg"}) {
    EXPECT_NE(outcome.out.find(text), std::string::npos) << text << "\n" << outcome.out;
  }
}

TEST(BandCommand, NeedsTolerancesAndAScene) {
  const ScratchFolder folder;
  const Outcome none = run_undula(
      {"hq", UNDULA_SOURCE_DIR "/data/scenes/wave_pump_fixed.toml", "--band", "--head", "50"}, folder.path());
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_EQ(none.out, "");
  EXPECT_NE(none.err.find("tolerance = "), std::string::npos) << none.err;

  const Outcome model = run_undula({"hq", UNDULA_SOURCE_DIR "/data/models/wave_pump_fixed.h5", "--frequency",
                                    "120", "--stroke", "0.5", "--band"},
                                   folder.path());
  EXPECT_EQ(model.exit_code, 2);
  EXPECT_NE(model.err.find("--band"), std::string::npos) << model.err;
}

} // namespace
} // namespace undula::apps
