// Wrong input, through the binary: exit code 2, one message that names what, seen, allowed and where, no
// output touched.
#include <gtest/gtest.h>

#include "tests/unit/apps/run_undula.hpp"
#include "tests/unit/apps/test_model.hpp"

namespace undula::apps {
namespace {

void expect_one_refusal(const Outcome& outcome, const std::vector<std::string>& texts) {
  EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_TRUE(outcome.err.starts_with("undula: ")) << outcome.err;
  for (const char* part : {"\n  seen:    ", "\n  allowed: ", "\n  where:   "}) {
    EXPECT_EQ(occurrences(outcome.err, part), 1) << outcome.err;
  }
  for (const std::string& text : texts) {
    EXPECT_NE(outcome.err.find(text), std::string::npos) << "no \"" << text << "\" in\n" << outcome.err;
  }
}

std::string test_name(const testing::TestParamInfo<std::filesystem::path>& info) {
  return info.param.stem().string();
}

class BadScene : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(BadScene, IsRefusedWithOneMessage) {
  const ScratchFolder folder;
  const auto expected = expected_texts(GetParam());
  ASSERT_FALSE(expected.empty()) << "no expectation in " << GetParam();
  const Outcome outcome = run_undula({"check", GetParam().string()}, folder.path());
  expect_one_refusal(outcome, expected);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

INSTANTIATE_TEST_SUITE_P(Corpus, BadScene, testing::ValuesIn(corpus("bad/scenes")), test_name);

class BadData : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(BadData, IsRefusedBeforeThePictureIsTouched) {
  const ScratchFolder folder;
  const auto model = write_small_model(folder.path());
  const auto picture = folder.path() / "kept.png";
  std::ofstream(picture) << "an older picture";
  for (const char* command : {"hq", "validate"}) {
    const Outcome outcome = run_undula({command, model.string(), "--frequency", "120", "--stroke", "0.5",
                                        "--data", GetParam().string(), "--plot", picture.string()},
                                       folder.path());
    auto texts = expected_texts(GetParam());
    texts.push_back(GetParam().filename().string());
    expect_one_refusal(outcome, texts);
    EXPECT_EQ(text_of(picture), "an older picture");
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "kept.gp"));
  }
}

INSTANTIATE_TEST_SUITE_P(Corpus, BadData, testing::ValuesIn(corpus("bad/data")), test_name);

TEST(BadInput, TheMessageOfASceneNamesFileAndLine) {
  const ScratchFolder folder;
  const std::string scene = UNDULA_SOURCE_DIR "/tests/data/bad/scenes/negative_viscosity.toml";
  const Outcome outcome = run_undula({"check", scene}, folder.path());
  // Line 1 holds the expectation; viscosity is the second key of [fluid].
  EXPECT_NE(outcome.err.find("where:   " + scene + ":9\n"), std::string::npos) << outcome.err;
}

TEST(BadInput, MissingFilesAreNamed) {
  const ScratchFolder folder;
  expect_one_refusal(run_undula({"check", "nowhere.toml"}, folder.path()), {"nowhere.toml"});
  expect_one_refusal(run_undula({"hq", "nowhere.h5", "--frequency", "120", "--stroke", "0.5"}, folder.path()),
                     {"nowhere.h5"});
  const auto model = write_small_model(folder.path());
  expect_one_refusal(
      run_undula({"hq", model.string(), "--frequency", "120", "--stroke", "0.5", "--data", "no.csv"},
                 folder.path()),
      {"no.csv"});
}

TEST(BadInput, AForeignFileIsNotAModel) {
  const ScratchFolder folder;
  expect_one_refusal(run_undula({"hq", UNDULA_SOURCE_DIR "/data/measured/corwave_120hz_0.53mm.csv",
                                 "--frequency", "120", "--stroke", "0.5"},
                                folder.path()),
                     {"corwave_120hz_0.53mm.csv"});
}

TEST(BadInput, ATruncatedModelIsRefused) {
  const ScratchFolder folder;
  const auto model = write_small_model(folder.path());
  std::filesystem::resize_file(model, std::filesystem::file_size(model) / 2);
  expect_one_refusal(
      run_undula({"hq", model.string(), "--frequency", "120", "--stroke", "0.5"}, folder.path()),
      {"small.h5"});
}

TEST(BadInput, ImpossibleOperatingPointsAreRefused) {
  const ScratchFolder folder;
  const std::string model = write_small_model(folder.path()).string();
  expect_one_refusal(run_undula({"hq", model, "--frequency", "0", "--stroke", "0.5"}, folder.path()), {});
  expect_one_refusal(run_undula({"hq", model, "--frequency", "120", "--stroke", "-0.5"}, folder.path()), {});
  for (const char* heads : {"40:62", "40:62:-2", "40:62:0", "forty", "40,,50", "40:1e9:1", "inf", "50mmHg"}) {
    expect_one_refusal(
        run_undula({"hq", model, "--frequency", "120", "--stroke", "0.5", "--head", heads}, folder.path()),
        {"--head", heads});
  }
}

TEST(BadInput, ReducedModelsAreNotMadeOfNonlinearSolids) {
  const ScratchFolder folder;
  for (const char* solid : {"neo-hookean", "saint-venant-kirchhoff"}) {
    expect_one_refusal(run_undula({"train", UNDULA_SOURCE_DIR "/data/scenes/wave_pump_fixed_training.toml",
                                   "--set", std::string("model.solid=") + solid},
                                  folder.path()),
                       {"linear operators", "[model]"});
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  }
}

TEST(BadInput, CampaignsDoNotScaleTheStroke) {
  const ScratchFolder folder;
  expect_one_refusal(run_undula({"train", UNDULA_SOURCE_DIR "/data/scenes/wave_pump_fixed_training.toml",
                                 "--set", "operating_point.stroke_scale=1.1"},
                                folder.path()),
                     {"stroke_scale = 1.1", "[operating_point]"});
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(BadInput, PicturesHaveToBePngInAnExistingFolder) {
  const ScratchFolder folder;
  const std::string model = write_small_model(folder.path()).string();
  for (const char* picture : {"curve.pdf", "no_such_folder/curve.png"}) {
    expect_one_refusal(
        run_undula({"hq", model, "--frequency", "120", "--stroke", "0.5", "--plot", picture}, folder.path()),
        {picture});
  }
}

TEST(BadInput, OverridesAreCheckedByTheSameTable) {
  const ScratchFolder folder;
  const std::string scene = UNDULA_SOURCE_DIR "/data/scenes/wave_pump_fixed.toml";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"operating_point.stroke_cm=0.053", "\"operating_point.stroke_mm\""},
      {"operating_point.frequency_Hz=0", "out of range"},
      {"operating_point.frequency_Hz=fast", "wrong type"},
      {"membrane.poison=0.3", "\"membrane.poisson\""},
      {"model.space=3d", "does not offer yet"},
      {"operating_point.head_mmHg", "key=value"},
      {"operating_point.head_mmHg=", "key=value"},
      {"time.periods=3\nname = \"x\"", "wrong type"}};
  for (const auto& [text, expected] : cases) {
    expect_one_refusal(run_undula({"check", scene, "--set", text}, folder.path()), {expected, "--set"});
  }
}

TEST(BadInput, UsageErrorsExitWithTwoAndHelpWithZero) {
  const ScratchFolder folder;
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {}, {"fly"}, {"check"}, {"hq"}, {"hq", "m.h5", "--frequency", "x"}}) {
    const Outcome outcome = run_undula(words, folder.path());
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_NE(outcome.err, "");
  }
  const Outcome help = run_undula({"check", "--help"}, folder.path());
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_NE(help.out.find("operating_point.stroke_mm: a number in [0, 100] mm"), std::string::npos)
      << help.out;
}

} // namespace
} // namespace undula::apps
