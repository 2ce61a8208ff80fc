#include "fom/output/folder_lock.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <vector>

#include "rom/base/error.hpp"
#include "tests/unit/fom/io_folder.hpp"

namespace undula::fom {
namespace {

class FolderLockTest : public FolderTest {
protected:
  std::string refusal() const {
    try {
      const FolderLock second(folder / "run", "a test");
    } catch (const InputError& error) {
      return error.what();
    }
    return "no refusal";
  }
};

TEST_F(FolderLockTest, TheSecondIsRefusedAndToldWhoHoldsIt) {
  {
    const FolderLock first(folder / "run", "undula solve pump.toml");
    EXPECT_TRUE(first.held());
    const auto message = refusal(); // flock counts descriptors, so one process can stand for two
    EXPECT_NE(message.find("process " + std::to_string(::getpid())), std::string::npos) << message;
    EXPECT_NE(message.find("undula solve pump.toml"), std::string::npos) << message;
  }
  EXPECT_EQ(refusal(), "no refusal");
  EXPECT_FALSE(std::filesystem::exists(folder / "run"))
      << "nothing is left of a folder in which nothing was done";
}

TEST_F(FolderLockTest, LeavesOtherFilesAlone) {
  std::filesystem::create_directory(folder / "run");
  { const FolderLock lock(folder / "run", "a test"); }
  EXPECT_TRUE(std::filesystem::is_empty(folder / "run"));
  {
    const FolderLock lock(folder / "new", "a test");
    std::ofstream(folder / "new" / "table.csv") << "1";
  }
  EXPECT_TRUE(std::filesystem::exists(folder / "new" / "table.csv"));
}

TEST_F(FolderLockTest, AKilledHolderBlocksNobody) {
  const pid_t child = ::fork();
  if (child == 0) {
    const FolderLock lock(folder / "run", "a test");
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "run" / lock_name));
  EXPECT_EQ(refusal(), "no refusal");
}

TEST_F(FolderLockTest, ManyAtOnceGiveOneHolder) {
  std::vector<pid_t> children;
  for (int k = 0; k < 8; ++k) {
    const pid_t child = ::fork();
    if (child == 0) {
      // Every holder counts itself in and out; were there two, one would see the other's mark.
      for (int round = 0; round < 200; ++round) {
        try {
          const FolderLock lock(folder / "run", "a test");
          const auto mark = folder / "mark";
          if (std::filesystem::exists(mark)) ::_exit(1);
          std::ofstream(mark) << "here";
          std::filesystem::remove(mark);
        } catch (const InputError&) {
        }
      }
      ::_exit(0);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  }
}

} // namespace
} // namespace undula::fom
