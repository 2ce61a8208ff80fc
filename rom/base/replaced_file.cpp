#include "rom/base/replaced_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "rom/base/error.hpp"

namespace undula {
namespace {

constexpr std::string_view suffix = ".partial";

/// Whether a name still leads to an open file.
bool is_linked(int descriptor) {
  struct stat status = {};
  return ::fstat(descriptor, &status) == 0 && status.st_nlink > 0;
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

/// Makes renames durable; some file systems refuse, which harms nothing.
void sync_folder(const std::filesystem::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

} // namespace

ReplacedFile::ReplacedFile(std::filesystem::path target) : target_(std::move(target)) {
  static std::atomic<int> counter = 0;
  partial_ = target_;
  partial_ += "." + std::to_string(::getpid()) + "." + std::to_string(counter++) + std::string(suffix);
  do { // once more where somebody took the new file for a leftover before it was locked
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = ::open(partial_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (descriptor_ < 0 && (errno == ENOSPC || errno == EDQUOT)) fail(errno);
    if (descriptor_ < 0)
      throw InputError("cannot create file", std::strerror(errno), "a path in an existing, writable folder",
                       target_.string());
    ::flock(descriptor_, LOCK_EX); // without locks leftovers are not told apart, and stay
  } while (!is_linked(descriptor_));
}

ReplacedFile::ReplacedFile(ReplacedFile&& other) noexcept
    : target_(std::move(other.target_)),
      partial_(std::move(other.partial_)),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

ReplacedFile& ReplacedFile::operator=(ReplacedFile&& other) noexcept {
  if (this == &other) return *this;
  discard();
  target_ = std::move(other.target_);
  partial_ = std::move(other.partial_);
  descriptor_ = std::exchange(other.descriptor_, -1);
  return *this;
}

ReplacedFile::~ReplacedFile() { discard(); }

void ReplacedFile::discard() noexcept {
  if (descriptor_ < 0) return;
  ::unlink(partial_.c_str());
  ::close(std::exchange(descriptor_, -1));
}

void ReplacedFile::fail(int reason) {
  discard();
  throw NumericsError("cannot write file: " + std::string(std::strerror(reason)), target_.string(),
                      "free space on the disk, then start again (`solve` with --restart)");
}

void ReplacedFile::require_open() const {
  if (descriptor_ < 0)
    throw NumericsError("cannot write file: it is complete already", target_.string(), "a new file");
}

void ReplacedFile::write(std::string_view bytes) {
  require_open();
  while (!bytes.empty()) {
    const auto count = ::write(descriptor_, bytes.data(), bytes.size());
    if (count > 0) bytes.remove_prefix(static_cast<std::size_t>(count));
    if (count < 0 && errno != EINTR) fail(errno);
  }
}

void ReplacedFile::write(std::span<const std::byte> bytes) {
  write(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

void ReplacedFile::put_in_place() {
  if (::rename(partial_.c_str(), target_.c_str()) != 0) fail(errno);
  if (::close(std::exchange(descriptor_, -1)) != 0)
    throw NumericsError("cannot complete file: " + std::string(std::strerror(errno)), target_.string(),
                        "free space on the disk");
}

void ReplacedFile::commit() {
  require_open();
  // Data first, then the name: a crash in between leaves the old target.
  if (::fsync(descriptor_) != 0) fail(errno);
  put_in_place();
  sync_folder(folder_of(target_));
}

void ReplacedFile::commit_unsynced() {
  require_open();
  put_in_place();
}

void sync_files(const std::filesystem::path& folder, std::span<const std::filesystem::path> files) {
  for (const auto& file : files) {
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    const bool synced = descriptor >= 0 && ::fsync(descriptor) == 0;
    const int reason = errno;
    if (descriptor >= 0) ::close(descriptor);
    if (!synced)
      throw NumericsError("cannot bring file to the disk: " + std::string(std::strerror(reason)),
                          file.string(), "free space on the disk, then start again (`solve` with --restart)");
  }
  sync_folder(folder);
}

bool is_partial_of(std::string_view name, std::string_view target) {
  return name.size() > target.size() + suffix.size() && name.starts_with(target) &&
         name[target.size()] == '.' && name.ends_with(suffix);
}

void remove_leftovers_of(const std::filesystem::path& target) {
  std::error_code ignored;
  const auto name = target.filename().string();
  for (const auto& entry : std::filesystem::directory_iterator(folder_of(target), ignored))
    if (is_partial_of(entry.path().filename().string(), name)) remove_leftover(entry.path());
}

void remove_leftover(const std::filesystem::path& partial) {
  const int descriptor = ::open(partial.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor < 0) return;
  struct stat status = {};
  const bool ours = ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
  if (ours && ::flock(descriptor, LOCK_EX | LOCK_NB) == 0) ::unlink(partial.c_str());
  ::close(descriptor);
}

} // namespace undula
