// The full-order runs of a campaign on disk: one record per operating point, none lost, none computed twice.
#pragma once

#include <mpi.h>

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fom/levels/periodic_run.hpp"
#include "fom/output/scene_stamp.hpp"
#include "fom/output/time_series.hpp"
#include "fom/scene/scene.hpp"
#include "training/campaign/record_store.hpp"
#include "training/training.hpp"

namespace undula::training {

/// Told after every step of a run on every rank, with the communicator of the ranks that share the run.
using AfterStep = std::function<void(MPI_Comm)>;

struct Snapshots {
  std::string unit;
  Eigen::MatrixXd values; ///< [unknown, in a numbering independent of ranks][snapshot]
};

/// What a run leaves behind.
struct RunRecord {
  OperatingPoint point;
  RunState state = RunState::failed;
  std::string reason;                         ///< why it failed or does not repeat, else empty
  std::vector<double> times;                  ///< [snapshot], s
  std::map<std::string, Snapshots> snapshots; ///< by field; as many columns as `times` has entries
  CycleMeans cycles;                          ///< of all periods
  int plain_periods = 0;                      ///< PeriodicRun::plain_periods; 0: not recorded
  std::map<std::string, double> seconds;      ///< wall time by phase, "total" among them
};

/// What is read of a record: snapshots are nearly all of it.
enum class RecordParts { all, without_snapshots };

/// Stamp of a campaign: the scene without its operating point, but with the settings that decide what is
/// recorded.
SceneStamp stamp_campaign(const Scene& scene);

/// The stamp that folders of version 2 have: that of the lowest corner of the box, so that a box with other
/// lower ends was another campaign.
SceneStamp stamp_campaign_of_version_2(const Scene& scene);

/// The right to compute one point, see RecordClaim.
class Claim {
public:
  const OperatingPoint& point() const { return point_; }

private:
  friend class CampaignStore;
  Claim(RecordClaim record, const OperatingPoint& point) : record_(std::move(record)), point_(point) {}
  RecordClaim record_;
  OperatingPoint point_;
};

/// Folder with `campaign.h5` (the stamp) and one <point>.h5 per finished run, see RecordStore.
///
///   for (const auto& point : store.status(plan).pending)
///     if (const auto claim = store.try_claim(point)) store.store(*claim, compute(point));
class CampaignStore {
public:
  /// Opens or creates the folder and removes what killed runs left behind. Throws InputError if the folder
  /// belongs to another campaign (naming the keys that differ and both hashes) or is not empty and no
  /// campaign.
  CampaignStore(const std::filesystem::path& folder, const SceneStamp& stamp);

  /// The folder of a scene's campaign, of this version or of version 2.
  static CampaignStore of_scene(const std::filesystem::path& folder, const Scene& scene);

  struct Status {
    std::vector<OperatingPoint> pending; ///< without a whole record, in the order of the plan
    std::vector<std::string> damaged; ///< one message per record that cannot be used and counts as not done
  };
  Status status(std::span<const OperatingPoint> plan) const;

  /// Nothing if the point is done or being computed by another process.
  std::optional<Claim> try_claim(const OperatingPoint& point) const;

  /// Stores the record of a claimed point in one step. Throws InputError for a record of another point or
  /// one whose shapes disagree.
  void store(const Claim& claim, const RunRecord& record) const;

  /// Throws InputError if there is no whole record of the point.
  RunRecord load(const OperatingPoint& point, RecordParts parts = RecordParts::all) const;

  /// Points of all whole records in the folder, in the order of their names. What is wrong with a record that
  /// is none is appended to `damaged`.
  std::vector<OperatingPoint> recorded_points(std::vector<std::string>& damaged) const;

  std::filesystem::path record_file(const OperatingPoint& point) const;

private:
  bool is_done(const OperatingPoint& point, std::vector<std::string>* damaged = nullptr) const;
  RecordStore::Check check_of(const OperatingPoint& point) const;

  explicit CampaignStore(RecordStore records);

  RecordStore records_;
};

} // namespace undula::training
