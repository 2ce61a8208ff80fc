#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>

#include "fom/output/checkpoint.hpp"
#include "rom/base/error.hpp"
#include "rom/base/hdf5_file.hpp"
#include "tests/unit/fom/io_folder.hpp"

namespace undula::fom {
namespace {

using CheckpointTest = FolderTest;

Checkpoint example(int step) {
  Checkpoint state;
  state.step = step;
  state.time = step / 3.0;
  state.scalars = {{"outflow", 0.1}, {"ramp", -0.0}};
  state.arrays["velocity"] = {1.0 / 3, std::numeric_limits<double>::denorm_min(), -1e300, double(step)};
  state.arrays["velocity_old"] = {};
  state.scene = {"85944171f73967e8", "[fluid]\ndensity_g_per_cm3 = 1.06\n"};
  state.provenance = {{"ranks", "2"}};
  return state;
}

std::string message_of(const std::filesystem::path& file, const SceneStamp& scene) {
  try {
    load_checkpoint(file, scene);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST_F(CheckpointTest, ComesBackBitForBit) {
  const auto state = example(12);
  const auto file = save_checkpoint(state, folder / "checkpoints");
  EXPECT_EQ(file.filename(), "checkpoint_12.h5");
  const auto back = load_checkpoint(file, state.scene);
  EXPECT_EQ(back.step, state.step);
  EXPECT_EQ(std::bit_cast<std::uint64_t>(back.time), std::bit_cast<std::uint64_t>(state.time));
  EXPECT_EQ(back.arrays, state.arrays);
  EXPECT_EQ(back.scalars, state.scalars);
  EXPECT_TRUE(std::signbit(back.scalars.at("ramp")));
  EXPECT_EQ(back.scene.text, state.scene.text);
  EXPECT_EQ(back.provenance, state.provenance);
}

TEST_F(CheckpointTest, KeepsTheLastTwo) {
  EXPECT_FALSE(newest_checkpoint(folder / "none"));
  for (const int step : {5, 10, 95, 100}) save_checkpoint(example(step), folder);
  EXPECT_EQ(newest_checkpoint(folder), folder / "checkpoint_100.h5"); // by number, not by name
  EXPECT_FALSE(std::filesystem::exists(folder / "checkpoint_10.h5"));
  EXPECT_EQ(load_checkpoint(folder / "checkpoint_95.h5", example(0).scene).step, 95);
  // Set back to step 95, the run writes 97; the later checkpoint is of a past that did not happen.
  std::ofstream(folder / "notes.txt") << "not ours";
  save_checkpoint(example(97), folder);
  EXPECT_EQ(newest_checkpoint(folder), folder / "checkpoint_97.h5");
  int files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++files;
  EXPECT_EQ(files, 3); // 95, 97, notes.txt
}

TEST_F(CheckpointTest, OneThatWasRenamedIsNotTakenForAnotherStep) {
  const auto file = save_checkpoint(example(7), folder);
  std::filesystem::rename(file, folder / "checkpoint_9.h5");
  EXPECT_NE(message_of(folder / "checkpoint_9.h5", example(7).scene).find("another step"), std::string::npos);
}

TEST_F(CheckpointTest, RefusesAnotherScenesNamingBothHashes) {
  const auto file = save_checkpoint(example(1), folder);
  const SceneStamp other{"cbf29ce484222325", "[fluid]\ndensity_g_per_cm3 = 1.05\n"};
  const auto message = message_of(file, other);
  EXPECT_NE(message.find(other.hash), std::string::npos) << message;
  EXPECT_NE(message.find(example(1).scene.hash), std::string::npos) << message;
}

TEST_F(CheckpointTest, RefusesMissingTruncatedAndForeignFiles) {
  const auto scene = example(1).scene;
  EXPECT_NE(message_of(folder / "checkpoint_3.h5", scene).find("no such file"), std::string::npos);

  const auto file = save_checkpoint(example(1), folder);
  const auto size = std::filesystem::file_size(file);
  for (const auto kept : {size - 1, size / 2, std::uintmax_t{100}, std::uintmax_t{0}}) {
    std::filesystem::resize_file(file, kept);
    const auto message = message_of(file, scene);
    EXPECT_NE(message.find(kept > 0 ? "the file is damaged" : "no seal"), std::string::npos)
        << kept << ": " << message;
  }
  std::ofstream(file) << "step,time_s\n";
  EXPECT_NE(message_of(file, scene).find("no seal"), std::string::npos);

  auto foreign = Hdf5File::create(folder / "foreign.h5");
  foreign.write_attribute("/", "format", "undula model 1");
  foreign.commit();
  EXPECT_NE(message_of(folder / "foreign.h5", scene).find("kind 'undula model'"), std::string::npos);
}

TEST(SceneStamp, TellsScenesApart) {
  Scene scene;
  scene.name = "pump";
  scene.fluid.density = 1.06;
  const auto stamp = stamp_scene(scene);
  EXPECT_EQ(stamp.hash.size(), 16u);
  EXPECT_NE(stamp.text.find("1.06"), std::string::npos);
  scene.fluid.density = 1.05;
  EXPECT_NE(stamp_scene(scene).hash, stamp.hash);
}

} // namespace
} // namespace undula::fom
