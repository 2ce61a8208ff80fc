// Records of runs on a domain that moves by a map, as the unknowns and maps of consecutive steps.
#pragma once

#include "fom/levels/prepared_scene.hpp"
#include "training/campaign/campaign_store.hpp"
#include "training/training.hpp"

namespace undula::training {

/// Throws InputError unless the record holds every step of its last period, for every field, on the unknowns
/// of `disc`.
void check_moving_record(const Discretisation<2>& disc, const Scene& scene, const RunRecord& record,
                         const std::string& file);

/// State::x[0] of one snapshot: velocities, pressures, velocities of the solids. Natural order.
Eigen::VectorXd unknowns_at(const Discretisation<2>& disc, const RunRecord& record, Eigen::Index snapshot);

/// State::d[0] of one snapshot.
Eigen::VectorXd displacements_at(const Discretisation<2>& disc, const RunRecord& record,
                                 Eigen::Index snapshot);

/// Map of the domain at a snapshot (the third or a later one) and its rate by the scheme of second order.
DomainMap<2> map_at(const RunRecord& record, Eigen::Index snapshot, double time_step);

} // namespace undula::training
