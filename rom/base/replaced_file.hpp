// A file that is written aside and put in its place in one step.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

namespace undula {

/// Content on its way to `target`. It is written to "<target>.<process>.<number>.partial" beside it; commit()
/// brings it to the disk, renames it and brings the new name to the disk. A kill at any moment leaves either
/// the old or the new file; an object destroyed without commit() leaves the target as it was and nothing
/// beside it.
///
/// Errors: InputError where the folder is missing or not writable, NumericsError where the disk is full.
class ReplacedFile {
public:
  explicit ReplacedFile(std::filesystem::path target);
  ReplacedFile(ReplacedFile&& other) noexcept;
  ReplacedFile& operator=(ReplacedFile&& other) noexcept;
  ReplacedFile(const ReplacedFile&) = delete;
  ReplacedFile& operator=(const ReplacedFile&) = delete;
  ~ReplacedFile();

  void write(std::string_view bytes);
  void write(std::span<const std::byte> bytes);

  /// Nothing may be written afterwards.
  void commit();

  /// The same without waiting for the disk: what is there survives a kill of the process, not one of the
  /// machine, until sync_files() has been called.
  void commit_unsynced();

  bool open() const { return descriptor_ >= 0; }
  const std::filesystem::path& target() const { return target_; }

private:
  void require_open() const;
  void put_in_place();
  void discard() noexcept;
  [[noreturn]] void fail(int reason);

  std::filesystem::path target_, partial_;
  int descriptor_ = -1;
};

/// Brings files of one folder, and their names, to the disk.
void sync_files(const std::filesystem::path& folder, std::span<const std::filesystem::path> files);

/// Whether the name is that of a file on its way to `target` (both without folder).
bool is_partial_of(std::string_view name, std::string_view target);

/// Removes what killed processes left beside `target`. Files that a living process writes stay: it holds a
/// lock (flock) on them.
void remove_leftovers_of(const std::filesystem::path& target);

/// Removes one file named *.partial, unless a living process writes it.
void remove_leftover(const std::filesystem::path& partial);

} // namespace undula
