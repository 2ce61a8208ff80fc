#include "fom/output/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <utility>

#include "rom/base/error.hpp"

namespace undula::fom {
namespace {

std::string first_line(int descriptor) {
  std::array<char, 512> text{};
  const auto count = ::pread(descriptor, text.data(), text.size(), 0);
  const std::string all(text.data(), count > 0 ? static_cast<std::size_t>(count) : 0);
  return all.substr(0, all.find('\n'));
}

std::string host() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown host";
}

std::string local_time() {
  const std::time_t now = std::time(nullptr);
  std::tm parts = {};
  ::localtime_r(&now, &parts);
  std::array<char, 64> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M:%S", &parts);
  return text.data();
}

} // namespace

FolderLock::FolderLock(const std::filesystem::path& folder, const std::string& purpose)
    : folder_(std::filesystem::absolute(folder)), file_(folder_ / lock_name) {
  std::error_code error;
  made_folder_ = std::filesystem::create_directories(folder_, error);
  if (error)
    throw InputError("cannot create the folder", error.message(), "a writable place", folder.string());
  while (!lock_named_file()) {
  }
  write_holder(purpose);
}

/// False if the file, or the folder, was removed by its last holder meanwhile.
bool FolderLock::lock_named_file() {
  descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
  if (descriptor_ < 0 && errno == ENOENT) { // its last holder took the empty folder with it
    std::error_code ignored;
    made_folder_ = std::filesystem::create_directories(folder_, ignored) || made_folder_;
    if (std::filesystem::is_directory(folder_, ignored)) return false;
    errno = ENOENT;
  }
  if (descriptor_ < 0)
    throw InputError("cannot write to the folder", std::strerror(errno), "a writable folder",
                     folder_.string());
  int result = 0;
  do result = ::flock(descriptor_, LOCK_EX | LOCK_NB);
  while (result != 0 && errno == EINTR);
  if (result != 0 && errno == EWOULDBLOCK) {
    const std::string holder = first_line(descriptor_);
    ::close(std::exchange(descriptor_, -1));
    throw InputError("the folder is in use", holder.empty() ? "another process" : holder,
                     "one process at a time: wait until it has ended, stop it, or take another folder",
                     folder_.string());
  }
  held_ = result == 0;
  struct stat opened = {}, named = {};
  if (::fstat(descriptor_, &opened) == 0 && ::stat(file_.c_str(), &named) == 0 &&
      opened.st_ino == named.st_ino && opened.st_dev == named.st_dev)
    return true;
  ::close(std::exchange(descriptor_, -1));
  return false;
}

void FolderLock::write_holder(const std::string& purpose) const {
  const std::string text = "process " + std::to_string(::getpid()) + " on " + host() + ", " + purpose +
                           ", since " + local_time() + "\n";
  // Whoever is refused is told less where this fails; the lock holds all the same.
  if (::ftruncate(descriptor_, 0) != 0 || ::pwrite(descriptor_, text.data(), text.size(), 0) < 0) return;
}

FolderLock::FolderLock(FolderLock&& other) noexcept
    : folder_(std::move(other.folder_)),
      file_(std::move(other.file_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      held_(other.held_),
      made_folder_(other.made_folder_) {}

FolderLock::~FolderLock() {
  if (descriptor_ < 0) return;
  ::unlink(file_.c_str()); // while the lock is held: whoever has opened it sees that it is gone
  ::close(descriptor_);
  if (made_folder_) ::rmdir(folder_.c_str()); // fails where something is in it, as it should
}

} // namespace undula::fom
