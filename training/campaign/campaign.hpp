// The full-order runs of a plan, shared out over groups of ranks.
#pragma once

#include <mpi.h>

#include <functional>
#include <span>

#include "training/campaign/campaign_store.hpp"

namespace undula::training {

/// Told after every run of this process's group; `done` and `total` count the points of the plan.
using CampaignProgress = std::function<void(const RunRecord&, std::size_t done, std::size_t total)>;

/// Computes every point of `plan` without a record in `store`. The ranks of `world` form groups of
/// scene.training.ranks_per_run; a group takes the next free point until none is left. Groups of other
/// processes may work on the same store at the same time; the call returns when this process finds nothing
/// left to claim. `after_step` as of periodic_run: what it throws ends the campaign, without the run at hand
/// and with all records before it. Collective over `world`.
void run_campaign(const Scene& scene, std::span<const OperatingPoint> plan, const CampaignStore& store,
                  MPI_Comm world, const CampaignProgress& progress, const AfterStep& after_step = {});

} // namespace undula::training
