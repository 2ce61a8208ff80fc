// One full-order run of a campaign: marched until it repeats from period to period, with its snapshots.
#pragma once

#include "fom/levels/finite_element_level.hpp"
#include "fom/levels/periodic_run.hpp"
#include "training/campaign/campaign_store.hpp"
#include "training/training.hpp"

namespace undula::training {

/// The operating point of `scene` from rest (march_until_periodic), with snapshots of the last
/// scene.training.sampled_periods periods. Of a domain that moves by a map the map is one of the fields, and
/// scene.time.flow_error may end the run. A NumericsError ends in a record of state `failed`. Collective
/// over the communicator of the level; the record is complete on every rank. `after_step` is called after
/// every step on every rank; what it throws, other than a NumericsError, ends the run without a record.
RunRecord record_run(FiniteElementLevel& level, const Scene& scene, const AfterStep& after_step = {});

/// The same of any level, without snapshots, and ended by scene.time.flow_error where that is stated.
/// `comm`: the level's.
RunRecord record_flow(MarchingLevel& level, const Scene& scene, MPI_Comm comm,
                      const AfterStep& after_step = {});

/// Places of a field in the natural order of unknowns; the rows of its snapshots.
std::vector<int> velocity_unknowns(const Discretisation<2>& disc);
std::vector<int> pressure_unknowns(const Discretisation<2>& disc);
std::vector<int> displacement_unknowns(const Discretisation<2>& disc);

/// Names of the fields in RunRecord::snapshots.
inline constexpr const char* velocity_field = "velocity";
inline constexpr const char* pressure_field = "pressure";
inline constexpr const char* displacement_field = "displacement";
inline constexpr const char* solid_velocity_field = "solid_velocity"; ///< of `mapped` alone, as the next
inline constexpr const char* map_field = "map";                       ///< as State::map

} // namespace undula::training
