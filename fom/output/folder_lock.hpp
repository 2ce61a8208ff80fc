// One process at a time writes into a folder.
#pragma once

#include <filesystem>
#include <string>

namespace undula::fom {

/// The right to write into a folder for as long as the object lives: a lock of the operating system (flock)
/// on the file ".undula.lock" in it, which names its holder. It ends with the process, also by kill -9, and
/// nothing that is left behind can block a later one.
class FolderLock {
public:
  /// Creates the folder if it is missing. `purpose` is told to whoever is refused. Throws InputError where
  /// another process holds the lock, naming it, and where the folder cannot be written to.
  FolderLock(const std::filesystem::path& folder, const std::string& purpose);
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&&) = delete;
  ~FolderLock(); ///< removes the lock file, and the folder if this made it and nothing else is in it

  /// False where the file system knows no locks: nothing keeps another process out.
  bool held() const { return held_; }

private:
  bool lock_named_file();
  void write_holder(const std::string& purpose) const;

  std::filesystem::path folder_, file_;
  int descriptor_ = -1;
  bool held_ = false, made_folder_ = false;
};

/// Name of the lock file in a folder.
inline constexpr const char* lock_name = ".undula.lock";

} // namespace undula::fom
