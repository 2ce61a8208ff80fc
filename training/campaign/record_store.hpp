// Records on disk under names: none lost, none computed twice. What a record holds is the business of who
// stores it (campaigns, studies).
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fom/output/scene_stamp.hpp"
#include "rom/base/file_format.hpp"
#include "training/training.hpp"

namespace undula::training {

/// What a folder of records is called and how its stamp is written.
struct RecordKind {
  std::string noun;  ///< "campaign"; the stamp is noun.h5, its hash the attribute noun_hash
  FileFormat format; ///< of the stamp
  /// Which keys of two stamped scenes differ, of those that may matter.
  std::function<std::string(const std::string& before, const std::string& now)> difference;
};

/// The right to compute one record. It is a lock of the operating system (flock): it ends with its owner,
/// also by kill -9, and leaves nothing that could block a later run.
class RecordClaim {
public:
  RecordClaim(RecordClaim&& other) noexcept;
  RecordClaim& operator=(RecordClaim&&) = delete;
  ~RecordClaim();
  const std::string& name() const { return name_; }

private:
  friend class RecordStore;
  RecordClaim(int lock, std::string name) : lock_(lock), name_(std::move(name)) {}
  int lock_ = -1; // file descriptor
  std::string name_;
};

/// Folder with a stamp and one NAME.h5 per record. Any number of processes and hosts may work on it at once
/// (the file system must support flock). In a parallel run one rank of each group calls and tells the others.
class RecordStore {
public:
  /// Opens or creates the folder and removes what killed runs left behind. Throws InputError if the folder
  /// belongs to another stamp (naming the keys that differ and both hashes) or is not empty and has none.
  RecordStore(const std::filesystem::path& folder, RecordKind kind, SceneStamp stamp);

  /// Throws InputError for a file that is no whole record of this name.
  using Check = std::function<void(const std::filesystem::path&)>;

  /// Whether the record is there and whole; each is read through once. What is wrong with a damaged one is
  /// appended to `damaged`; LaterFormatError for one of a later version.
  bool is_done(const std::string& name, const Check& check,
               std::vector<std::string>* damaged = nullptr) const;

  /// Nothing if the record is done or being computed by another process.
  std::optional<RecordClaim> try_claim(const std::string& name, const Check& check) const;

  /// To be called when the claimed record lies whole in its file.
  void release(const RecordClaim& claim) const;

  std::filesystem::path file(const std::string& name) const { return folder_ / (name + ".h5"); }
  const std::filesystem::path& folder() const { return folder_; }
  const std::string& hash() const { return stamp_.hash; }

private:
  void check_stamp(const std::filesystem::path& path) const;
  void check_or_create_stamp() const;
  void remove_leftovers() const;

  std::filesystem::path folder_;
  RecordKind kind_;
  SceneStamp stamp_;
  /// Records found whole, with the time of their last change.
  mutable std::map<std::filesystem::path, std::filesystem::file_time_type> checked_;
};

} // namespace undula::training
