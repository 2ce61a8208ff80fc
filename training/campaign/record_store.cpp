#include "training/campaign/record_store.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <set>
#include <utility>

#include "rom/base/error.hpp"
#include "rom/base/file_format.hpp"

namespace undula::training {
namespace {

enum class Wait { no, yes };

/// Descriptor that holds the lock, or -1 if another process has it and we do not wait.
int lock(const std::filesystem::path& file, Wait wait, const std::string& noun) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor < 0)
    throw InputError("cannot create a lock file", std::strerror(errno), "a writable folder", file.string());
  int result = 0;
  do result = ::flock(descriptor, wait == Wait::yes ? LOCK_EX : LOCK_EX | LOCK_NB);
  while (result != 0 && errno == EINTR);
  if (result == 0) return descriptor;
  const int reason = errno;
  ::close(descriptor);
  if (reason == EWOULDBLOCK) return -1;
  throw InputError("cannot lock a file of the " + noun, std::strerror(reason), "a file system with flock",
                   file.string());
}

/// The lock of a record (or of the stamp) lies beside it. It is removed only where the whole record is in
/// place: whoever still gets hold of the removed file then finds the record done.
std::filesystem::path lock_file(std::filesystem::path record) { return record.replace_extension(".lock"); }

void remove_partials(const std::filesystem::path& target) {
  const auto prefix = target.filename().string() + ".";
  for (const auto& entry : std::filesystem::directory_iterator(target.parent_path())) {
    const auto name = entry.path().filename().string();
    std::error_code gone; // by another process that cleans up as well
    if (name.starts_with(prefix) && name.ends_with(".partial")) std::filesystem::remove(entry.path(), gone);
  }
}

} // namespace

RecordClaim::RecordClaim(RecordClaim&& other) noexcept
    : lock_(std::exchange(other.lock_, -1)), name_(std::move(other.name_)) {}

RecordClaim::~RecordClaim() {
  if (lock_ >= 0) ::close(lock_);
}

RecordStore::RecordStore(const std::filesystem::path& folder, RecordKind kind, SceneStamp stamp)
    : folder_(std::filesystem::absolute(folder)), kind_(std::move(kind)), stamp_(std::move(stamp)) {
  check_or_create_stamp();
  remove_leftovers();
}

void RecordStore::check_stamp(const std::filesystem::path& path) const {
  const auto stamp = Hdf5File::open_sealed(path);
  checked_version(stamp, kind_.format);
  const auto hash = stamp.read_attribute<std::string>("/", kind_.noun + "_hash");
  if (hash != stamp_.hash)
    throw InputError(
        "the folder holds the " + kind_.noun + " of another scene",
        kind_.noun + " hash " + hash + "; " + kind_.difference(stamp.read_text("scene"), stamp_.text),
        kind_.noun + " hash " + stamp_.hash + ", or another folder", path.string());
}

void RecordStore::check_or_create_stamp() const {
  const std::string stamp_name = kind_.noun + ".h5";
  const auto path = folder_ / stamp_name;
  if (std::filesystem::exists(path)) return check_stamp(path);
  std::filesystem::create_directories(folder_);
  for (const auto& entry : std::filesystem::directory_iterator(folder_))
    if (!entry.path().filename().string().starts_with(stamp_name) && entry.path().extension() != ".lock")
      throw InputError("the folder is not a " + kind_.noun, "\"" + entry.path().filename().string() + "\"",
                       "an empty or missing folder, or one with " + stamp_name, folder_.string());
  // Two processes may find the folder empty at the same time; the second one then checks the first one's
  // stamp.
  const RecordClaim guard(lock(lock_file(path), Wait::yes, kind_.noun), {});
  if (std::filesystem::exists(path)) return check_stamp(path);
  auto stamp = Hdf5File::create(path);
  stamp.write_attribute("/", "format", format_text(kind_.format));
  stamp.write_attribute("/", kind_.noun + "_hash", stamp_.hash);
  stamp.write_text("scene", stamp_.text);
  stamp.commit();
  std::filesystem::remove(lock_file(path));
}

void RecordStore::remove_leftovers() const {
  std::set<std::filesystem::path> records;
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    const auto name = entry.path().filename().string();
    const auto end = name.find(".h5.");
    if (end != std::string::npos && name.ends_with(".partial"))
      records.insert(folder_ / name.substr(0, end + 3));
  }
  for (const auto& record : records) {
    // A temporary file whose lock is held is being written at this moment.
    const RecordClaim owner(lock(lock_file(record), Wait::no, kind_.noun), {});
    if (owner.lock_ >= 0) remove_partials(record);
  }
}

bool RecordStore::is_done(const std::string& name, const Check& check,
                          std::vector<std::string>* damaged) const {
  const auto record = file(name);
  try {
    if (!std::filesystem::exists(record)) return false;
    std::error_code gone;
    const auto changed = std::filesystem::last_write_time(record, gone);
    if (const auto known = checked_.find(record);
        !gone && known != checked_.end() && known->second == changed)
      return true;
    check(record);
    checked_[record] = changed;
    return true;
  } catch (const LaterFormatError&) {
    throw; // not damaged: it would be replaced
  } catch (const InputError& error) {
    if (damaged != nullptr) damaged->emplace_back(error.what());
    return false;
  }
}

std::optional<RecordClaim> RecordStore::try_claim(const std::string& name, const Check& check) const {
  if (is_done(name, check)) return std::nullopt;
  const auto record = file(name);
  RecordClaim claim(lock(lock_file(record), Wait::no, kind_.noun), name);
  if (claim.lock_ < 0) return std::nullopt;
  // Only now is it certain that nobody stores this record between the question and the answer.
  if (is_done(name, check)) {
    std::filesystem::remove(lock_file(record));
    return std::nullopt;
  }
  remove_partials(record);
  return claim;
}

void RecordStore::release(const RecordClaim& claim) const {
  std::filesystem::remove(lock_file(file(claim.name())));
}

} // namespace undula::training
