#include "rom/base/hdf5_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <fstream>
#include <random>

#include "rom/base/error.hpp"

namespace undula {
namespace {

namespace fs = std::filesystem;

class Hdf5FileTest : public testing::Test {
protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("undula_hdf5_" + std::to_string(::getpid()) + "_" +
                                           testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string bytes(const fs::path& file) const {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void put(const fs::path& file, const std::string& content) const {
    std::ofstream(file, std::ios::binary) << content;
  }
  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  /// Message of the InputError that `action` must throw.
  template <class Action>
  std::string message(Action action) const {
    try {
      action();
    } catch (const InputError& error) {
      return error.what();
    }
    ADD_FAILURE() << "no InputError";
    return {};
  }

  fs::path folder_;
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_F(Hdf5FileTest, SaysWhatANameStandsFor) {
  const auto target = folder_ / "file.h5";
  auto written = Hdf5File::create(target);
  written.write("group/real", std::vector<double>{1.5});
  written.write("group/whole", std::vector<std::int64_t>{1, 2});
  written.write_text("group/words", "");
  written.commit();
  const auto file = Hdf5File::open_read(target);
  EXPECT_EQ(file.content("/"), Hdf5File::Content::group);
  EXPECT_EQ(file.content("group"), Hdf5File::Content::group);
  EXPECT_EQ(file.content("group/real"), Hdf5File::Content::real);
  EXPECT_EQ(file.content("group/whole"), Hdf5File::Content::integer);
  EXPECT_EQ(file.content("group/words"), Hdf5File::Content::text);
  EXPECT_TRUE(contains(message([&] { file.content("group/none"); }), "no dataset or group 'group/none'"));
}

TEST_F(Hdf5FileTest, KeepsValuesShapesAndAttributesBitForBit) {
  const std::vector<double> field = {0.1, -0.0, 1e-310, 1e300, 2.0 / 3.0, -7};
  const std::vector<int> ids = {-1, 2147483647, 0, 5, 6, 7, 8, 9};
  const std::vector<std::int64_t> large = {std::int64_t{1} << 60, -3};
  const std::string long_text(200000, 'x');
  auto file = Hdf5File::create(folder_ / "a.h5");
  file.write("fluid/velocity", field, {2, 3}, "cm/s");
  file.write("ids", ids, {2, 2, 2});
  file.write("large", large);
  file.write("nothing", std::vector<double>{}, {0, 4});
  file.write("scalar", std::vector<double>{4.5}, {});
  file.write_text("scene", long_text);
  file.write_text("empty", "");
  file.create_group("fluid/later");
  file.write_attribute("/", "kind", "test");
  file.write_attribute("fluid", "time", 0.25);
  file.write_attribute("fluid", "step", 12);
  file.write_attribute("fluid", "seed", std::int64_t{1} << 40);
  file.commit();

  const auto in = Hdf5File::open_read(folder_ / "a.h5");
  const auto read = in.read<double>("fluid/velocity", {2, 3});
  EXPECT_EQ(std::memcmp(read.data(), field.data(), field.size() * sizeof(double)), 0);
  EXPECT_EQ(in.unit("fluid/velocity"), "cm/s");
  EXPECT_EQ(in.unit("ids"), "");
  EXPECT_EQ(in.read<int>("ids", {2, 2, 2}), ids);
  EXPECT_EQ(in.read<std::int64_t>("ids"), std::vector<std::int64_t>(ids.begin(), ids.end()));
  EXPECT_EQ(in.read<std::int64_t>("large"), large);
  EXPECT_EQ(in.extents("nothing"), (Hdf5File::Shape{0, 4}));
  EXPECT_TRUE(in.read<double>("nothing").empty());
  EXPECT_EQ(in.read<double>("scalar", {}), std::vector<double>{4.5});
  EXPECT_EQ(in.read_text("scene"), long_text);
  EXPECT_EQ(in.read_text("empty"), "");
  EXPECT_EQ(in.read_attribute<std::string>("/", "kind"), "test");
  EXPECT_EQ(in.read_attribute<double>("fluid", "time"), 0.25);
  EXPECT_EQ(in.read_attribute<int>("fluid", "step"), 12);
  EXPECT_EQ(in.read_attribute<std::int64_t>("fluid", "seed"), std::int64_t{1} << 40);
  EXPECT_EQ(in.children("fluid"), (std::vector<std::string>{"later", "velocity"}));
  EXPECT_TRUE(in.exists("fluid/velocity"));
  EXPECT_TRUE(in.exists("/"));
  EXPECT_FALSE(in.exists("solid/velocity"));
  EXPECT_FALSE(in.has_attribute("fluid", "unit"));
}

TEST_F(Hdf5FileTest, NamesWhatIsMissingOrOfTheWrongKind) {
  auto out = Hdf5File::create(folder_ / "a.h5");
  out.write("field", std::vector<double>{1, 2, 3, 4, 5, 6}, {2, 3});
  out.write("large", std::vector<std::int64_t>{1});
  out.write_text("text", "abc");
  out.commit();
  const auto in = Hdf5File::open_read(folder_ / "a.h5");
  const auto shape = message([&] { (void)in.read<double>("field", {3, 2}); });
  EXPECT_TRUE(contains(shape, "'field'") && contains(shape, "2 x 3") && contains(shape, "3 x 2") &&
              contains(shape, "a.h5"))
      << shape;
  EXPECT_TRUE(contains(message([&] { (void)in.read<int>("field"); }), "64-bit real"));
  EXPECT_TRUE(contains(message([&] { (void)in.read<int>("large"); }), "64-bit integer"));
  EXPECT_TRUE(contains(message([&] { (void)in.read<double>("text"); }), "'text'"));
  EXPECT_TRUE(contains(message([&] { (void)in.read_text("field"); }), "'field'"));
  EXPECT_TRUE(contains(message([&] { (void)in.read<double>("absent"); }), "'absent'"));
  EXPECT_TRUE(contains(message([&] { (void)in.extents("absent"); }), "'absent'"));
  EXPECT_TRUE(contains(message([&] { (void)in.children("absent"); }), "'absent'"));
  EXPECT_TRUE(contains(message([&] { (void)in.read_attribute<double>("field", "unit"); }), "field@unit"));
}

TEST_F(Hdf5FileTest, RefusesMissingForeignAndEmptyFiles) {
  EXPECT_TRUE(contains(message([&] { Hdf5File::open_read(folder_ / "none.h5"); }), "no such file"));
  EXPECT_TRUE(contains(message([&] { Hdf5File::open_read(folder_); }), "not a regular file"));
  put(folder_ / "empty.h5", "");
  EXPECT_TRUE(contains(message([&] { Hdf5File::open_read(folder_ / "empty.h5"); }), "0 bytes"));
  std::mt19937 random(7);
  std::string noise(5000, ' ');
  for (auto& c : noise) c = static_cast<char>(random() & 255u);
  put(folder_ / "noise.h5", noise);
  testing::internal::CaptureStderr();
  EXPECT_TRUE(contains(message([&] { Hdf5File::open_read(folder_ / "noise.h5"); }), "noise.h5"));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "HDF5 prints its own errors";
}

TEST_F(Hdf5FileTest, RefusesAFileTruncatedAnywhere) {
  auto out = Hdf5File::create(folder_ / "whole.h5");
  out.write("a/b", std::vector<double>(500, 1.5), {500}, "cm");
  out.write_text("scene", "name = 1");
  out.commit();
  const auto whole = bytes(folder_ / "whole.h5");
  ASSERT_GT(whole.size(), 4000u);
  for (const std::size_t length : {std::size_t{1}, std::size_t{8}, std::size_t{60}, std::size_t{96},
                                   std::size_t{700}, whole.size() / 2, whole.size() - 9, whole.size() - 1}) {
    put(folder_ / "part.h5", whole.substr(0, length));
    EXPECT_TRUE(contains(message([&] { Hdf5File::open_read(folder_ / "part.h5"); }), "truncated")) << length;
  }
}

TEST_F(Hdf5FileTest, EveryByteIsUnderTheSeal) {
  auto out = Hdf5File::create(folder_ / "whole.h5");
  out.write("a/b", std::vector<double>(40, 1.5), {40}, "cm");
  out.write_attribute("/", "step", 3);
  out.commit();
  EXPECT_TRUE(Hdf5File::open_read(folder_ / "whole.h5").sealed());
  const auto whole = bytes(folder_ / "whole.h5");
  std::mt19937 random(11);
  for (int k = 0; k < 300; ++k) {
    auto part = whole;
    const auto at =
        k < 130 ? static_cast<std::size_t>(k) * 4 : random() % whole.size(); // the seal itself first
    part[at] = static_cast<char>(part[at] ^ (1 << (random() % 8)));
    put(folder_ / "flipped.h5", part);
    EXPECT_THROW(Hdf5File::open_sealed(folder_ / "flipped.h5"), InputError) << at;
    EXPECT_THROW(Hdf5File::open_read(folder_ / "flipped.h5"), InputError) << at;
  }
}

TEST_F(Hdf5FileTest, OtherHdf5ProgramsFindAFlippedBitInAnArrayToo) {
  auto out = Hdf5File::create(folder_ / "whole.h5");
  out.write("a", std::vector<double>(1000, 1.5), {10, 100});
  out.commit();
  auto part = bytes(folder_ / "whole.h5");
  const double value = 1.5;
  const auto at = part.find(std::string(reinterpret_cast<const char*>(&value), sizeof value)) + 800;
  part[at] = static_cast<char>(part[at] ^ 1);
  put(folder_ / "flipped.h5", part);
  const auto in = Hdf5File::open_unchecked(folder_ / "flipped.h5"); // as they read it: without our seal
  EXPECT_THROW((void)in.read<double>("a"), InputError);
}

TEST_F(Hdf5FileTest, TheSameNumbersMakeTheSameBytes) {
  for (const char* name : {"one.h5", "two.h5"}) {
    auto out = Hdf5File::create(folder_ / name);
    out.write("a/b", std::vector<double>(40, 1.5), {40}, "cm");
    out.write_text("scene", "name = 1");
    out.commit();
  }
  EXPECT_EQ(bytes(folder_ / "one.h5"), bytes(folder_ / "two.h5"));
}

TEST_F(Hdf5FileTest, AFullDiskIsOneErrorThatLeavesNothingBehind) {
  put(folder_ / "target.h5", "old content");
  const pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{20000, 20000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    int code = 1;
    try {
      auto file = Hdf5File::create(folder_ / "target.h5");
      file.write("a", std::vector<double>(100000, 1.0));
      file.commit();
    } catch (const NumericsError& error) {
      code = contains(error.what(), "cannot write file") && contains(error.what(), "free space") ? 0 : 2;
    }
    ::_exit(code);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_EQ(bytes(folder_ / "target.h5"), "old content");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(Hdf5FileTest, LeftoversOfTheDeadGoAndThoseOfTheLivingStay) {
  const auto target = folder_ / "a.h5";
  put(folder_ / "a.h5.4711.0.partial", "left by a kill");
  put(folder_ / "b.h5.4711.0.partial", "of another file");
  auto alive = Hdf5File::create(target);
  remove_leftovers_of(target);
  EXPECT_FALSE(fs::exists(folder_ / "a.h5.4711.0.partial"));
  EXPECT_TRUE(fs::exists(folder_ / "b.h5.4711.0.partial"));
  alive.write("a", std::vector<double>{1});
  alive.commit();
  EXPECT_EQ(Hdf5File::open_sealed(target).read<double>("a"), std::vector<double>{1});
}

TEST_F(Hdf5FileTest, LeavesTheTargetUntouchedUntilCommit) {
  const auto target = folder_ / "target.h5";
  put(target, "old content");
  {
    auto file = Hdf5File::create(target);
    file.write("a", std::vector<double>(10000, 1.0));
    EXPECT_EQ(bytes(target), "old content");
    EXPECT_EQ(entries(), 2u);
  }
  EXPECT_EQ(bytes(target), "old content");
  EXPECT_EQ(entries(), 1u) << "temporary left behind";
  auto file = Hdf5File::create(target);
  file.write("a", std::vector<double>{3});
  auto moved = std::move(file);
  moved.commit();
  EXPECT_EQ(entries(), 1u);
  EXPECT_EQ(Hdf5File::open_read(target).read<double>("a"), std::vector<double>{3});
  EXPECT_THROW(moved.commit(), NumericsError);
  EXPECT_THROW(moved.write("b", std::vector<double>{3}), NumericsError);
  EXPECT_EQ(Hdf5File::open_read(target).read<double>("a"), std::vector<double>{3});
}

TEST_F(Hdf5FileTest, SurvivesAKillWhileWriting) {
  const auto target = folder_ / "target.h5";
  put(target, "old content");
  const pid_t child = ::fork();
  if (child == 0) {
    auto file = Hdf5File::create(target);
    file.write("a", std::vector<double>(100000, 1.0));
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(bytes(target), "old content");
}

TEST_F(Hdf5FileTest, ReportsWhereItCannotWrite) {
  EXPECT_TRUE(contains(message([&] { Hdf5File::create(folder_ / "no_folder" / "a.h5"); }), "no_folder"));
  auto file = Hdf5File::create(folder_ / "a.h5");
  file.write("a", std::vector<double>{1});
  EXPECT_THROW(file.write("a", std::vector<double>{2}), NumericsError);
  EXPECT_TRUE(contains(message([&] { file.write("c", std::vector<double>{1, 2, 3}, {2, 2}); }), "2 x 2"));
}

} // namespace
} // namespace undula
