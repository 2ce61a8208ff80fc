// Models, checkpoints and run records with random damage: refused, or the very numbers that were written.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>

#include "fom/output/checkpoint.hpp"
#include "rom/base/error.hpp"
#include "rom/fixed_domain/model.hpp"
#include "tests/unit/rom/synthetic_operators.hpp"
#include "training/campaign/run_record_file.hpp"
#include "training/training.hpp"

namespace undula::training {
namespace {

namespace fs = std::filesystem;

std::string bytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Bits flipped, ends cut off, blocks exchanged, overwritten, lost or repeated.
std::string damaged(std::string content, std::mt19937& random) {
  const auto below = [&](std::size_t limit) { return random() % limit; };
  const auto size = content.size();
  const auto length = 1 + below(std::size_t{1} << below(12));
  const auto from = below(size - length), to = below(size - length);
  switch (below(7)) {
    case 0:
      content[from] = static_cast<char>(content[from] ^ (1 << below(8)));
      break;
    case 1:
      for (std::size_t k = 0; k <= below(20); ++k) {
        const auto at = below(size);
        content[at] = static_cast<char>(content[at] ^ (1 << below(8)));
      }
      break;
    case 2:
      content.resize(below(size));
      break;
    case 3: {
      const auto count = std::min(length, size - std::max(from, to));
      const std::string one = content.substr(from, count), other = content.substr(to, count);
      content.replace(from, count, other);
      content.replace(to, count, one);
      break;
    }
    case 4:
      content.replace(from, length, length, static_cast<char>(below(2) == 0 ? 0 : random()));
      break;
    case 5:
      content.erase(from, length);
      break;
    default:
      content.insert(to, content.substr(from, length));
  }
  return content;
}

class DamagedFiles : public testing::Test {
protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("undula_damaged_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// Damages the file that `write` makes `count` times; `read` has to throw InputError, at once.
  void expect_refusals(const fs::path& file, int count, const std::function<void()>& write,
                       const std::function<void()>& read) {
    write();
    const std::string whole = bytes(file);
    EXPECT_NO_THROW(read());
    std::mt19937 random(5);
    int changed = 0;
    while (changed < count) {
      const std::string content = damaged(whole, random);
      if (content == whole) continue;
      ++changed;
      std::ofstream(file, std::ios::binary | std::ios::trunc) << content;
      const auto begin = std::chrono::steady_clock::now();
      EXPECT_THROW(read(), InputError) << file.filename() << ", number " << changed;
      EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
      if (HasFailure()) {
        fs::copy_file(file, folder_.string() + ".kept", fs::copy_options::overwrite_existing);
        FAIL() << "the damaged file is kept as " << folder_.string() << ".kept";
      }
    }
  }

  void damage_all(int count) {
    const auto model = folder_ / "model.h5";
    expect_refusals(
        model, count,
        [&] {
          rom::Model made;
          made.operators = rom::synthetic_operators({4, 2, 2}, 0.1);
          made.steps_per_period = 48;
          made.box = {80, 140, 0.1, 0.8, 0, 70};
          made.references = {{120, 0.53, 40, 3.25, 1e-4, true, 3.26, 0.01, 0.02, 512.5}};
          made.error_safety = 2;
          made.provenance["scene"] = "synthetic";
          rom::save_model(made, model.string());
        },
        [&] { (void)rom::load_model(model.string()); });

    const SceneStamp scene{"0123456789abcdef", "name = \"pump\"\n"};
    expect_refusals(
        folder_ / "checkpoint_12.h5", count,
        [&] {
          Checkpoint state{12, 0.5, {{"last_step", 0.01}}, {}, scene, {{"ranks", "1"}}};
          for (const char* name : {"x_0", "x_1", "d_0", "d_1"}) state.arrays[name].assign(300, 0.1);
          save_checkpoint(state, folder_);
        },
        [&] { (void)load_checkpoint(folder_ / "checkpoint_12.h5", scene); });

    const OperatingPoint point{120, 0.053, 5e4};
    expect_refusals(
        folder_ / "record.h5", count,
        [&] {
          RunRecord record;
          record.point = point;
          record.state = RunState::periodic;
          record.times = {0.1, 0.2};
          for (const char* name : {"velocity", "pressure", "displacement"})
            record.snapshots[name] = {"cm/s", Eigen::MatrixXd::Random(40, 2)};
          record.cycles = {{"outflow_l_per_min"}, {1, 2}, {1, 2}, {0, 1}, {2, 3}};
          record.seconds = {{"total", 2.5}};
          write_run_record(record, "hash", folder_ / "record.h5");
        },
        [&] { (void)read_run_record(folder_ / "record.h5", "hash", point); });
  }

  fs::path folder_;
};

TEST_F(DamagedFiles, AThousandOfEachAreRefused) { damage_all(1000); }

TEST_F(DamagedFiles, TheRecordOfAnotherPointIsRefused) {
  const OperatingPoint point{120, 0.053, 5e4}, other{120, 0.053, 6e4};
  RunRecord record;
  record.point = point;
  record.state = RunState::failed;
  write_run_record(record, "hash", folder_ / "record.h5");
  EXPECT_NO_THROW((void)read_run_record(folder_ / "record.h5", "hash", point));
  EXPECT_THROW((void)read_run_record(folder_ / "record.h5", "hash", other), InputError);
  EXPECT_THROW(check_run_record(folder_ / "record.h5", "hash", other), InputError);
}

} // namespace
} // namespace undula::training
