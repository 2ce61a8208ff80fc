// From the runs of a campaign on a moving domain to its reduced model.
#pragma once

#include "rom/moving_domain/moving_model.hpp"
#include "training/moving_domain/cubature.hpp"
#include "training/moving_domain/moving_bases.hpp"
#include "training/sampling/plan.hpp"

namespace undula::training {

struct BuiltMovingModel {
  rom::MovingModel model;
  MovingBases bases;                 ///< its basis is that of the model
  Cubature cubature;                 ///< as the model's
  std::vector<std::string> left_out; ///< runs that failed
  double flow_range_l_per_min = 0;
  std::map<std::string, double> seconds;
};

/// Modes and weights from the training points of `plan`; flows of the model at the held-out points, of which
/// nine in ten are within its stated error. Runs are those of `store`. Phases "basis", "cubature", "judge".
BuiltMovingModel build_moving_model(const Scene& scene, const SamplingPlan& plan, const CampaignStore& store,
                                    PhaseTimer& timer);

} // namespace undula::training
