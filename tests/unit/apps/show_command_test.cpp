// undula show: the pictures of a run on disk are those that were drawn when it ended.
#include <gtest/gtest.h>

#include <map>

#include "run_undula.hpp"

namespace undula::apps {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

const std::string scenes = UNDULA_SOURCE_DIR "/data/scenes/";

/// What the pictures are drawn from, by name.
std::map<std::string, std::string> drawn_numbers(const fs::path& folder) {
  std::map<std::string, std::string> numbers;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".dat" || entry.path().extension() == ".gp")
      numbers[entry.path().filename().string()] = text_of(entry.path());
  return numbers;
}

std::map<std::string, std::string> all_files(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files[entry.path().string()] = text_of(entry.path());
  return files;
}

class ShowCommand : public testing::Test {
protected:
  Outcome run(const Words& words) { return run_undula(words, folder.path()); }

  /// Draws a run again, elsewhere and in its own folder.
  void expect_the_same_pictures(const Words& solve, std::size_t pictures) {
    const auto ended = run(solve);
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const fs::path here = folder.path() / "run";
    const auto first = drawn_numbers(here);
    EXPECT_EQ(first.size(), 2 * pictures); // numbers and script each
    const auto before = all_files(here);

    const auto elsewhere = run({"show", "run", "--output", "again"});
    ASSERT_EQ(elsewhere.exit_code, 0) << elsewhere.err;
    EXPECT_TRUE(all_files(here) == before);
    const auto again = drawn_numbers(folder.path() / "again");
    ASSERT_EQ(again.size(), first.size());
    for (const auto& [name, numbers] : first)
      if (name.ends_with(".dat")) {
        EXPECT_TRUE(again.at(name) == numbers) << name; // too long to print
      }

    for (const auto& [name, numbers] : first) fs::remove(here / name);
    ASSERT_EQ(run({"show", "run"}).exit_code, 0);
    EXPECT_TRUE(drawn_numbers(here) == first);
  }

  ScratchFolder folder;
};

TEST_F(ShowCommand, DrawsARunOfThinGapsAgain) {
  expect_the_same_pictures({"solve", scenes + "wave_pump_thin_gap.toml", "--output", "run", "--plot", "--set",
                            "time.periods=2", "--set", "thin_gap.cells=32"},
                           5);
}

TEST_F(ShowCommand, DrawsAFullOrderRunAgainWithItsWallShear) {
  expect_the_same_pictures(
      {"solve", scenes + "wave_pump_fixed.toml", "--output", "run", "--plot", "--set", "time.periods=1",
       "--set", "time.steps_per_period=8", "--set", "mesh.gap_elements=2", "--set", "time.ramp_periods=0.5"},
      6);
}

// The mesh of the fluid is that of the last state, not that of rest.
TEST_F(ShowCommand, DrawsAMovedDomainAgain) {
  for (const std::string coupling : {"explicit", "mapped"}) {
    expect_the_same_pictures({"solve", scenes + "flap_in_channel.toml", "--output", "run", "--plot",
                              "--force", "--set", "time.end_s=0.1", "--set", "output.statistics_from_s=0",
                              "--set", "domain.size_mm=3", "--set", "model.coupling=" + coupling},
                             4); // speed, pressure, the close-up, stress of the solids
    fs::remove_all(folder.path() / "again");
  }
}

TEST_F(ShowCommand, DrawsRecordedCurvesAgain) {
  const std::string model = UNDULA_SOURCE_DIR "/data/models/wave_pump_fixed.h5";
  const Words words{"hq",     model,      "--frequency", "120",    "--stroke", "0.53",
                    "--head", "60,40,50", "--plot",      "hq.png", "--json"};
  const auto printed = run(words);
  ASSERT_EQ(printed.exit_code, 0) << printed.err;
  std::ofstream(folder.path() / "curve.json") << printed.out;
  ASSERT_EQ(run({"show", "curve.json"}).exit_code, 0);
  EXPECT_EQ(text_of(folder.path() / "curve.dat"), text_of(folder.path() / "hq.dat"));
  EXPECT_NE(text_of(folder.path() / "curve.dat"), "");
}

TEST_F(ShowCommand, DrawsCurvesWithTheirBandsAndMeasuredPoints) {
  const std::string data = UNDULA_SOURCE_DIR "/data/measured/corwave_120hz_0.53mm.csv";
  const auto printed = run({"hq", scenes + "wave_pump_thin_gap.toml", "--head", "40,60", "--band", "--data",
                            data, "--set", "thin_gap.cells=16", "--plot", "hq.png", "--json"});
  ASSERT_EQ(printed.exit_code, 0) << printed.err;
  std::ofstream(folder.path() / "curve.json") << printed.out;
  ASSERT_EQ(run({"show", "curve.json", "--data", data, "--output", "again.png"}).exit_code, 0);
  EXPECT_EQ(text_of(folder.path() / "again.dat"), text_of(folder.path() / "hq.dat"));
}

TEST_F(ShowCommand, RefusesWhatIsNoRun) {
  const auto refused = [&](const Words& words, const std::string& part) {
    const auto outcome = run(words);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  };
  refused({"show", "none"}, "does not exist");
  fs::create_directories(folder.path() / "empty");
  refused({"show", "empty"}, "no scene_resolved.toml");
  refused({"show", "empty", "--data", "a.csv"}, "--data with a file");
  std::ofstream(folder.path() / "notes.json") << "{\"a\": 1}";
  refused({"show", "notes.json"}, "hq FILE --json");
  std::ofstream(folder.path() / "notes.txt") << "not JSON";
  refused({"show", "notes.txt"}, "hq FILE --json");

  ASSERT_EQ(run({"solve", scenes + "wave_pump_thin_gap.toml", "--output", "run", "--set", "time.periods=1",
                 "--set", "thin_gap.cells=16"})
                .exit_code,
            0);
  refused({"show", "run", "--set", "membrane.poisson=0.4"}, "another scene");
  fs::remove_all(folder.path() / "run/checkpoints");
  refused({"show", "run"}, "no state to draw");
}

} // namespace
} // namespace undula::apps
