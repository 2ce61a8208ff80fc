// What would be believed without a word is told: on stderr, in the answer, or by a refusal.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "apps/apps.hpp"
#include "apps/output/gnuplot.hpp"
#include "rom/base/error.hpp"
#include "tests/unit/apps/run_undula.hpp"
#include "tests/unit/apps/small_scene.hpp"
#include "tests/unit/apps/test_model.hpp"

namespace undula::apps {
namespace {

using Words = std::vector<std::string>;

const std::string root = UNDULA_SOURCE_DIR;
const std::string thin_gap = root + "/data/scenes/wave_pump_thin_gap.toml";
const std::string measured = root + "/data/measured/corwave_120hz_0.63mm.csv";

/// Five steps of the small scene.
std::string write_channel(const ScratchFolder& folder) {
  return write_small_scene(folder.path() / "channel.toml", "0.05");
}

void expect_told(const Outcome& outcome, const std::string& text) {
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find(text), std::string::npos) << "no \"" << text << "\" in\n" << outcome.err;
}

TEST(NothingSilent, TheVersionNamesCommitAndLibraries) {
  const ScratchFolder folder;
  const Outcome outcome = run_undula({"--version"}, folder.path());
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_TRUE(outcome.out.starts_with("undula ")) << outcome.out;
  for (const char* part : {"\ncommit ", "\nPETSc ", "\nSLEPc ", "\nMPI ", "\nCGAL ", "\nEigen ", "\nHDF5 "}) {
    EXPECT_EQ(occurrences(outcome.out, part), 1) << outcome.out;
  }
}

TEST(NothingSilent, AModelInPlaceOfASceneIsToldFromBadToml) {
  const ScratchFolder folder;
  for (const char* command : {"solve", "check", "train"}) {
    const Outcome outcome = run_undula({command, root + "/data/models/wave_pump_fixed.h5"}, folder.path());
    EXPECT_EQ(outcome.exit_code, 2) << command;
    EXPECT_NE(outcome.err.find("a binary file"), std::string::npos) << outcome.err;
  }
}

TEST(NothingSilent, CheckSaysWhereTheWeightsComeFrom) {
  const ScratchFolder folder;
  const auto origins = [&](const Words& settings) {
    Words words = {"check", write_channel(folder), "--json"};
    words.insert(words.end(), settings.begin(), settings.end());
    const auto json = nlohmann::json::parse(run_undula(words, folder.path()).out);
    std::map<std::string, std::string> origin;
    for (const auto& weight : json.at("stabilisation")) {
      origin[weight.at("key")] =
          weight.at("value").get<std::string>() + " " + weight.at("origin").get<std::string>();
    }
    return origin;
  };
  auto derived = origins({});
  EXPECT_EQ(derived["reference_velocity_cm_per_s"], "0.5 derived"); // the inflow has half grown at the end
  EXPECT_EQ(derived["reference_time_s"], "0.01 derived");
  EXPECT_EQ(derived["divergence"], "0.005 derived");
  EXPECT_EQ(derived["velocity_scale"], "local derived");
  auto stated =
      origins({"--set", "stabilisation.weights=published", "--set", "stabilisation.divergence=0.2"});
  EXPECT_EQ(stated["divergence"], "0.2 stated");
  EXPECT_EQ(stated["velocity_jump"], "0.05 published");
  EXPECT_EQ(stated["velocity_scale"], "reference published");
}

TEST(NothingSilent, CheckSaysWhatARunWouldBe) {
  const ScratchFolder folder;
  const Outcome outcome = run_undula({"check", write_channel(folder), "--json"}, folder.path());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json.at("steps"), 5);
  EXPECT_GT(json.at("unknowns").get<int>(), 300);
  EXPECT_EQ(json.at("walls"), (Words{"lower", "upper"}));
  ASSERT_EQ(json.at("meshes").size(), 2u);
  const auto cells = json["meshes"][0]["cells"].get<double>() + json["meshes"][1]["cells"].get<double>();
  EXPECT_NEAR(json.at("estimated_cells").get<double>() / cells, 1, 0.5);
  EXPECT_NEAR(json["meshes"][0]["high_mm"][0].get<double>(), 40, 1e-9);
  const Outcome text = run_undula({"check", write_channel(folder)}, folder.path());
  for (const char* part : {"walls: lower, upper\n", "0.000 to 40.000", " unknowns per step, 5 steps\n"}) {
    EXPECT_NE(text.out.find(part), std::string::npos) << text.out;
  }
}

TEST(NothingSilent, DataOfAnotherOperatingPointAreToldByEveryCommand) {
  const ScratchFolder folder;
  const std::string model = write_small_model(folder.path()).string();
  const std::string told = "was measured at another operating point: 120 Hz, stroke 0.63 mm";
  const Words point = {"--frequency", "120", "--stroke", "0.5", "--data", measured};
  const auto run = [&](Words words, const Words& more) {
    words.insert(words.end(), point.begin(), point.end());
    words.insert(words.end(), more.begin(), more.end());
    return run_undula(words, folder.path());
  };
  expect_told(run({"hq", model}, {"--head", "50"}), told);
  expect_told(run({"validate", model}, {"--head", "50"}), told);
  expect_told(run({"report", model}, {"--points", "2"}), told);
  const Words quick = {"--set", "thin_gap.cells=24",
                       "--set", "time.steps_per_period=24",
                       "--set", "training.snapshots_per_period=24",
                       "--set", "time.periods=2"};
  Words more = quick;
  more.insert(more.end(), {"--head", "50"});
  expect_told(run({"hq", thin_gap}, more), told);
  expect_told(run({"validate", thin_gap}, more), told);
  // The same point: no word.
  const Outcome same =
      run_undula({"hq", model, "--frequency", "120", "--stroke", "0.63", "--data", measured, "--head", "50"},
                 folder.path());
  EXPECT_EQ(same.err.find("operating point"), std::string::npos) << same.err;
}

TEST(NothingSilent, ErrorsFarOutsideOfTheBoxAreUnknownInTableAndJson) {
  const ScratchFolder folder;
  const std::string model = write_small_model(folder.path()).string();
  const Words far = {"hq", model, "--frequency", "20", "--stroke", "0.5", "--head", "50"};
  EXPECT_NE(run_undula(far, folder.path()).out.find("unknown"), std::string::npos);
  Words json = far;
  json.emplace_back("--json");
  const Outcome outcome = run_undula(json, folder.path());
  EXPECT_TRUE(nlohmann::json::parse(outcome.out)["points"][0]["error_l_per_min"].is_null()) << outcome.out;
}

TEST(NothingSilent, OptionsForPetscThatNothingAsksForAreTold) {
  const ScratchFolder folder;
  const std::string scene = write_channel(folder);
  const Outcome outcome =
      run_undula({"solve", scene, "--output", "a", "--", "-fsi_ksp_monitr", "-ksp_monitor"}, folder.path());
  expect_told(outcome, "nothing asked for these PETSc options: -fsi_ksp_monitr -ksp_monitor");
  EXPECT_EQ(run_undula({"solve", scene, "--output", "b", "--", "-fsi_ksp_type", "preonly"}, folder.path())
                .err.find("PETSc"),
            std::string::npos);
}

TEST(NothingSilent, OptionsFilesAreToldAndAnswersThatDoNotSolveAreRefused) {
  const ScratchFolder folder;
  const std::string scene = write_channel(folder);
  std::ofstream(folder.path() / ".petscrc") << "-fsi_ksp_type preonly\n-fsi_pc_type jacobi\n";
  const Outcome outcome = run_undula({"solve", scene, "--output", "a"}, folder.path());
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("the command line does not name are in force"), std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.err.find("does not solve the system"), std::string::npos) << outcome.err;
  EXPECT_EQ(run_undula({"solve", scene, "--output", "b", "--", "-skip_petscrc"}, folder.path()).exit_code, 0);
}

TEST(NothingSilent, StatisticsOfASignalThatStillGrowsAreTold) {
  const ScratchFolder folder;
  const Outcome outcome = run_undula({"solve", write_channel(folder), "--output", "a"}, folder.path());
  expect_told(outcome, "still change by more than 5 %"); // the inflow rises until t = 0.1 s
  EXPECT_NE(outcome.err.find("kinetic_energy_uJ_per_cm"), std::string::npos) << outcome.err;
  EXPECT_NE(text_of(folder.path() / "a" / "statistics.csv").find(",mean_change,amplitude_change\n"),
            std::string::npos);
}

TEST(NothingSilent, AProfileThatStatesOtherMaterialsIsTold) {
  const ScratchFolder folder;
  std::string profile = text_of(root + "/data/profiles/wave_pump_profile.toml");
  profile.replace(profile.find("young = 1.686e7"), 15, "young = 1.0");
  std::ofstream(folder.path() / "profile.toml") << profile;
  const Outcome outcome =
      run_undula({"check", thin_gap, "--set", "geometry.profile=profile.toml"}, folder.path());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("materials.membrane.young = 1; what counts is"), std::string::npos)
      << outcome.out;
}

TEST(NothingSilent, FoldersBehindLinksAndEndingsInCapitalsAreRead) {
  const ScratchFolder folder;
  const auto data = folder.path() / "elsewhere" / "data";
  std::filesystem::create_directories(data);
  std::filesystem::copy(root + "/data/scenes", data / "scenes");
  std::filesystem::copy(root + "/data/profiles", data / "profiles");
  std::filesystem::create_directories(folder.path() / "home");
  std::filesystem::create_directory_symlink(data / "scenes", folder.path() / "home" / "scenes");
  EXPECT_EQ(run_undula({"check", "home/scenes/wave_pump_thin_gap.toml"}, folder.path()).exit_code, 0);
  std::filesystem::rename(data / "scenes" / "wave_pump_thin_gap.toml", data / "scenes" / "PUMP.TOML");
  const Outcome outcome = run_undula(
      {"hq", "home/scenes/PUMP.TOML", "--head", "50", "--set", "thin_gap.cells=24", "--set",
       "time.steps_per_period=24", "--set", "training.snapshots_per_period=24", "--set", "time.periods=2"},
      folder.path());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
}

TEST(NothingSilent, TheOthersThatMpirunStartsPrintNothing) {
  const ScratchFolder folder;
  const std::string model = write_small_model(folder.path()).string();
  const std::string command =
      "cd '" + folder.path().string() +
      "' && mpirun --allow-run-as-root --oversubscribe --bind-to none -np 2 '" UNDULA_BINARY "' hq '" +
      model + "' --frequency 120 --stroke 0.5 --head 50 --json >out.txt 2>err.txt";
  ASSERT_EQ(std::system(command.c_str()), 0) << text_of(folder.path() / "err.txt");
  EXPECT_EQ(occurrences(text_of(folder.path() / "out.txt"), "\"model\""), 1);
  for (const char* rank : {"0", "1"}) { // of commands without MPI
    setenv("OMPI_COMM_WORLD_RANK", rank, 1);
    const Outcome outcome = run_undula(
        {"hq", model, "--frequency", "120", "--stroke", "0.5", "--head", "50", "--json"}, folder.path());
    unsetenv("OMPI_COMM_WORLD_RANK");
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(occurrences(outcome.out, "\"model\""), rank[0] == '0' ? 1 : 0);
  }
  setenv("OMPI_COMM_WORLD_RANK", "1", 1);
  const Outcome other =
      run_undula({"check", UNDULA_SOURCE_DIR "/data/scenes/wave_pump_thin_gap.toml"}, folder.path());
  unsetenv("OMPI_COMM_WORLD_RANK");
  EXPECT_EQ(other.exit_code, 0);
  EXPECT_EQ(other.out, "");
}

TEST(NothingSilent, TextsForGnuplotStayOnOneLine) {
  EXPECT_EQ(gnuplot_string("two\nsystem('touch x')\r\t\x7f"), "'two system(''touch x'')   '");
  for (const char* picture : {"a\nb.png", "a\tb.png", "\x01.png"}) {
    EXPECT_THROW(check_picture_name(picture), InputError);
  }
  EXPECT_NO_THROW(check_picture_name("it's \xc3\xa9.png"));
}

TEST(NothingSilent, NamesOfScenesAreNoCommands) {
  const ScratchFolder folder;
  const std::string scene = write_channel(folder);
  for (const char* name :
       {"name=\"a\\nsystem(1)\"", "name=\"../a\"", "name=\"a\\\\b\"", "name=\".a\"", "name=\"a\\u007f\""}) {
    const Outcome outcome = run_undula({"check", scene, "--set", name}, folder.path());
    EXPECT_EQ(outcome.exit_code, 2) << name << outcome.err;
    EXPECT_NE(outcome.err.find("\"name\""), std::string::npos) << outcome.err;
  }
}

} // namespace
} // namespace undula::apps
