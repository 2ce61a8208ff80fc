// Head-flow curves of full-order scenes: the periodic state at every head.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fom/levels/level.hpp"
#include "training/campaign/campaign_store.hpp"
#include "training/training.hpp"

namespace undula::training {

/// One head of a curve, surface units. Numbers are means of the last period where the state is periodic; of a
/// thin-gap state that is not, of the last three periods. Flows and powers are NaN where the numerics failed.
struct CurvePoint {
  double head_mmHg = 0;
  double flow_l_per_min = 0, inflow_l_per_min = 0;
  double spread_l_per_min = 0; ///< largest minus smallest mean of the last three periods
  double power_mW = 0;         ///< hydraulic: head times flow
  double holder_power_mW = 0;  ///< put in by the actuator; NaN where it was not recorded
  double speed_max_cm_per_s = 0, clearance_min_mm = 0;
  int periods = 0; ///< computed at this head
  bool periodic = false;
  std::string reason;                    ///< why it is not, else empty
  std::map<std::string, double> seconds; ///< by phase, "total" among them
};

/// The point that a run comes to. Numbers of a run that is not periodic are means over `periods_averaged`.
CurvePoint curve_point(const RunRecord& record, int periods_averaged = 1);

/// The curve of a scene at `heads_mmHg`, in their order; `on_point` after every point.
///
/// Finite elements: periodic_run from rest at every head. Thin gaps: heads are gone through upwards, the
/// first from rest, the others from the last state of the one before, or from the line through the last two;
/// until two successive periods agree: their mean outflow to training.periodic_tolerance of the root mean
/// square of the outflow, and the displacements at their ends to the same part of the largest displacement;
/// or for time.periods periods at most. A NumericsError ends a point, not the curve: the next head starts
/// from rest. Collective; complete on every rank.
std::vector<CurvePoint> head_flow_curve(PreparedLevel& level, const Scene& scene,
                                        std::span<const double> heads_mmHg,
                                        const std::function<void()>& on_point = {});

/// The same from the scene alone; `timer` takes the phases of the preparation.
std::vector<CurvePoint> head_flow_curve(const Scene& scene, std::span<const double> heads_mmHg, MPI_Comm comm,
                                        PhaseTimer& timer, const std::function<void()>& on_point = {});

} // namespace undula::training
