// The runs of a study on disk: one record per point, none lost, none computed twice.
#pragma once

#include "training/campaign/record_store.hpp"
#include "training/study/study_plan.hpp"

namespace undula::training {

struct StudyQuantity {
  std::string name; ///< ends in the unit
  double value = 0; ///< NaN: not known
};

/// What a run of a study comes to.
struct StudyRecord {
  std::vector<double> values; ///< of the keys of the plan, in their units
  std::string state;          ///< "periodic", "settled", "not periodic", "ended", "failed", "refused"
  std::string reason;         ///< why it failed, was refused or does not repeat, else empty
  std::vector<StudyQuantity> quantities; ///< none where it failed or was refused
  double seconds = 0;                    ///< wall time
};

/// Stamp of a study: the scene, what else of it shapes the quantities, and the keys that are varied.
SceneStamp stamp_study(const Scene& scene, std::span<const std::string> keys);

/// Folder with `study.h5` (the stamp) and one record per run, see RecordStore.
class StudyStore {
public:
  StudyStore(const std::filesystem::path& folder, const SceneStamp& stamp);

  /// Runs of the plan without a whole record; `damaged` gets a message per record that cannot be used.
  std::vector<std::size_t> pending(const StudyPlan& plan, std::vector<std::string>* damaged = nullptr) const;

  /// Nothing if the run is done or being computed by another process.
  std::optional<RecordClaim> try_claim(const std::vector<double>& values) const;

  /// Stores the record of a claimed run in one step.
  void store(const RecordClaim& claim, const StudyRecord& record) const;

  /// Throws InputError if there is no whole record of these values.
  StudyRecord load(const std::vector<double>& values) const;

private:
  RecordStore::Check check_of(const std::vector<double>& values) const;

  RecordStore records_;
};

} // namespace undula::training
