// From the records of a campaign to a reduced model and its report.
#pragma once

#include <optional>

#include "rom/fixed_domain/field_bases.hpp"
#include "training/reduction/judge.hpp"
#include "training/sampling/plan.hpp"

namespace undula::training {

struct TrainedModel {
  rom::Model model;
  std::vector<ModeRow> modes;     ///< modes against error on the held-out runs
  std::vector<ProjectedRun> runs; ///< training runs, then held-out runs
  double flow_range = 0;          ///< largest minus smallest mean flow of all runs, cm^3/s
  double captured_velocity = 0, captured_pressure = 0, captured_displacement = 0;
  std::vector<std::string> left_out;     ///< one message per run that is not periodic and was not used
  std::optional<rom::FieldBases> fields; ///< where they were asked for
};

/// Builds bases from the periodic training runs, projects, judges on the periodic held-out runs. For one rank
/// (the full-order operators are assembled on MPI_COMM_SELF). Throws InputError if no training run is
/// periodic. `with_fields`: with what draws the model's fields.
TrainedModel build_model(const Scene& scene, const SamplingPlan& plan, const CampaignStore& store,
                         PhaseTimer& timer, bool with_fields = false);

} // namespace undula::training
