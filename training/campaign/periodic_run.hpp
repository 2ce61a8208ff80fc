// One full-order run of a campaign: marched until it repeats from period to period, helped by extrapolation.
#pragma once

#include <chrono>

#include "fom/levels/simulation.hpp"
#include "training/campaign/campaign_store.hpp"
#include "training/training.hpp"

namespace undula::training {

/// Reduced rank extrapolation (Mesina 1977; Sidi 1991) of states z_0..z_m, one period apart: weights
/// gamma_0.. gamma_{m-1}, sum 1, that minimise |sum gamma_i (z_{i+1} - z_i)|. The limit of the sequence is
/// estimated by sum gamma_i z_{i+1}. Columns of `differences` are z_{i+1} - z_i in coordinates whose
/// Euclidean norm matters.
Eigen::VectorXd extrapolation_weights(const Eigen::MatrixXd& differences);

/// Marches the operating point of `scene` from rest until two successive periods agree: the changes of
/// velocity and of displacement over a period, each relative in the mass norm, are below
/// scene.training.periodic_tolerance; or for scene.time.periods periods at most. Slow modes (columns of fluid
/// in channels, squeeze films) are shortened by extrapolation over the last periods; the record's last
/// periods are always plain time steps. Snapshots of the last scene.training.sampled_periods periods. A
/// NumericsError ends in a record of state `failed`. Collective over the communicator of `prepared`; the
/// record is complete on every rank. `after_step` is called after every step on every rank; what it throws,
/// other than a NumericsError, ends the run without a record.
RunRecord periodic_run(PreparedScene& prepared, const Scene& scene, const AfterStep& after_step = {});

/// What every run leaves in its record at its end: the cycle means of its series, wall seconds by phase and
/// in total since `begin`.
void complete_record(RunRecord& record, const TimeSeries& series, int steps_per_period,
                     const PhaseTimer& timer, std::chrono::steady_clock::time_point begin);

/// Places of a field in the natural order of unknowns; the rows of its snapshots.
std::vector<int> velocity_unknowns(const Discretisation<2>& disc);
std::vector<int> pressure_unknowns(const Discretisation<2>& disc);
std::vector<int> displacement_unknowns(const Discretisation<2>& disc);

/// Names of the fields in RunRecord::snapshots.
inline constexpr const char* velocity_field = "velocity";
inline constexpr const char* pressure_field = "pressure";
inline constexpr const char* displacement_field = "displacement";

} // namespace undula::training
