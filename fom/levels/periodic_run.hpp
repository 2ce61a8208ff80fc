// A march until the state repeats from period to period.
#pragma once

#include <map>
#include <span>
#include <string>

#include "fom/levels/march.hpp"
#include "fom/output/time_series.hpp"
#include "fom/problem/blood_damage_law.hpp"

namespace undula::fom {

enum class RunState {
  periodic,     ///< the last periods repeat within the tolerance
  settled,      ///< they differ, but the mean flow is known as well as the scene asks (time.flow_error)
  not_periodic, ///< ran to its end, does not repeat
  failed,       ///< stopped by a NumericsError
};

struct PeriodicRun {
  RunState state = RunState::failed;
  std::string reason;                    ///< why it failed or does not repeat, else empty
  CycleMeans cycles;                     ///< of all periods, numbered from 1, see cycle_columns
  int plain_periods = 0;                 ///< the last ones, that follow one another without a jump
  BloodDamageLaw blood;                  ///< of the scene
  double period = 0;                     ///< s
  std::map<std::string, double> seconds; ///< wall time by phase, "total" among them
};

/// Whether the mean of these flows, one per period after the smooth start and in l/min, is known as well as
/// the scene asks: its standard error by at least six periods.
bool flow_is_known(const Scene& scene, std::span<const double> flows_l_per_min);

/// Columns of PeriodicRun::cycles.
std::vector<std::string> cycle_columns();

/// Marches on from `state`, which is at the end of a period or at rest, at the operating point of `scene`,
/// for scene.time.periods periods at most. When a period within the smooth start has ended, nothing is
/// compared yet. Two strategies, by the level:
///
/// - Levels with a metric, whose states may be added: periodic when velocity and displacement over a period
///   change by less than scene.training.periodic_tolerance, each relative in the metric. Slow modes (columns
///   of fluid in channels, squeeze films) are shortened by extrapolation over the last periods; the last
///   scene.training.sampled_periods periods are always plain time steps.
/// - Others: periodic when the mean outflow of two successive periods agrees to periodic_tolerance of the
///   root mean square of the outflow, and the displacements at their ends to the same part of the largest
///   displacement.
///
/// Where scene.time.flow_error is stated, a march also ends once the mean flow is known as well as that.
///
/// A NumericsError ends in a run of state `failed`. `state` is the last good one. Collective; complete on
/// every rank.
PeriodicRun march_until_periodic(MarchingLevel& level, const Scene& scene, State& state,
                                 const StepCallback& on_step = {});

} // namespace undula::fom
