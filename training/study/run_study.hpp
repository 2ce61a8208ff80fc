// The runs of a study, shared out over groups of ranks.
#pragma once

#include <mpi.h>

#include <functional>
#include <string>
#include <vector>

#include "training/campaign/campaign_store.hpp"
#include "training/study/study_store.hpp"

namespace undula::training {

/// The scene at values of the keys; throws InputError where it refuses them. The same on every rank.
using SceneAtValues = std::function<Scene(const std::vector<double>& values)>;

/// Told after every run of this process's group; `done` and `total` count the runs of the plan.
using StudyProgress = std::function<void(const StudyRecord&, std::size_t done, std::size_t total)>;

/// Computes every point of `plan` without a record in `store`. The ranks of `world` form groups of
/// `ranks_per_run`; a group takes the next free point until none is left. Pumps are marched until they repeat
/// (march_until_periodic) and give the quantities of curve_quantities.hpp at their head; other scenes run to
/// their end and give mean, amplitude and last value of every column of their time series. A scene that
/// refuses its values, and numerics that fail, are records. `after_step` as in run_campaign. Collective.
void run_study(const StudyPlan& plan, const SceneAtValues& scene_at, const StudyStore& store,
               int ranks_per_run, MPI_Comm world, const StudyProgress& progress,
               const AfterStep& after_step = {});

} // namespace undula::training
