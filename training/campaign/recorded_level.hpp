// A level whose runs are those of a campaign: what is recorded is read, what is not is run and recorded.
#pragma once

#include <mpi.h>

#include "fom/levels/level.hpp"
#include "training/campaign/campaign_store.hpp"

namespace undula::training {

class RecordedLevel final : public Level {
public:
  /// `store`: of the campaign of `scene` (stamp_campaign). `after_step` as in run_campaign.
  RecordedLevel(const Scene& scene, const CampaignStore& store, MPI_Comm comm, AfterStep after_step = {});

  std::string name() const override;
  int unknowns() const override { return 0; } ///< prepared run by run

  /// At every head the run of that operating point. Collective.
  std::vector<CurvePoint> curve(const Scene& scene, std::span<const double> heads_mmHg,
                                const std::function<void()>& on_point = {}) override;
  std::vector<std::string> remarks(const Scene& scene, std::span<const double> heads_mmHg) const override;

  /// Runs made for a question, not read.
  int runs() const { return runs_; }

private:
  Scene scene_;
  const CampaignStore& store_;
  MPI_Comm comm_;
  AfterStep after_step_;
  int runs_ = 0;
};

/// What a record says of its operating point, as a curve does.
CurvePoint curve_point_of(const Scene& scene, const RunRecord& record);

} // namespace undula::training
