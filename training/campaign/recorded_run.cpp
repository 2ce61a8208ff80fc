#include "training/campaign/recorded_run.hpp"

#include <algorithm>
#include <deque>
#include <utility>

namespace undula::training {

namespace {

/// Snapshots of the last periods, in the order of time.
struct Sampler {
  int every = 1;
  std::size_t capacity = 0;
  std::deque<std::pair<double, State>> kept;

  void take(const State& state) {
    if (state.step % every != 0) return;
    State copy;
    copy.x[0] = state.x[0];
    copy.d[0] = state.d[0];
    copy.map[0] = state.map[0];
    kept.emplace_back(state.time, std::move(copy));
    if (kept.size() > capacity) kept.pop_front();
  }

  void write(const Discretisation<2>& disc, RunRecord& record) const {
    const auto store = [&](const char* field, const char* unit, auto&& values_of) {
      Snapshots snapshots;
      snapshots.unit = unit;
      for (std::size_t k = 0; k < kept.size(); ++k) {
        const Eigen::VectorXd values = values_of(kept[k].second);
        if (k == 0) snapshots.values.resize(values.size(), static_cast<Eigen::Index>(kept.size()));
        snapshots.values.col(static_cast<Eigen::Index>(k)) = values;
      }
      record.snapshots.emplace(field, std::move(snapshots));
    };
    const auto velocities = velocity_unknowns(disc), pressures = pressure_unknowns(disc),
               displacements = displacement_unknowns(disc);
    store(velocity_field, "cm/s", [&](const State& state) { return state.x[0](velocities); });
    store(pressure_field, "dyn/cm^2", [&](const State& state) { return state.x[0](pressures); });
    store(displacement_field, "cm", [&](const State& state) { return state.d[0](displacements); });
    if (kept.empty() || kept.front().second.map[0].size() == 0) return finish(record);
    // Of a moving domain also what its projection is made of.
    store(solid_velocity_field, "cm/s", [&](const State& state) { return state.x[0](displacements); });
    store(map_field, "cm", [&](const State& state) { return state.map[0]; });
    finish(record);
  }

  void finish(RunRecord& record) const {
    for (const auto& [time, state] : kept) record.times.push_back(time);
  }
};

RunRecord record_of(const Scene& scene, PeriodicRun run) {
  RunRecord record;
  record.point = scene.operating_point;
  record.state = run.state;
  record.reason = std::move(run.reason);
  record.cycles = std::move(run.cycles);
  record.plain_periods = run.plain_periods;
  record.seconds = std::move(run.seconds);
  return record;
}

} // namespace

RunRecord record_flow(MarchingLevel& level, const Scene& scene, MPI_Comm comm, const AfterStep& after_step) {
  State state = level.initial_state();
  return record_of(scene, march_until_periodic(level, scene, state, [&](const State&, const Observation&) {
                     if (after_step) after_step(comm);
                   }));
}

std::vector<int> velocity_unknowns(const Discretisation<2>& disc) {
  std::vector<int> unknowns;
  for (int node = 0; node < disc.velocity_nodes(); ++node)
    for (int c = 0; c < 2; ++c) unknowns.push_back(disc.velocity_unknown(node, c));
  return unknowns;
}

std::vector<int> pressure_unknowns(const Discretisation<2>& disc) {
  std::vector<int> unknowns;
  for (int node = 0; node < disc.vertex_nodes(); ++node) unknowns.push_back(disc.pressure_unknown(node));
  return unknowns;
}

std::vector<int> displacement_unknowns(const Discretisation<2>& disc) {
  std::vector<int> unknowns;
  for (int unknown = disc.fluid_unknowns(); unknown < disc.unknowns(); ++unknown) unknowns.push_back(unknown);
  return unknowns;
}

RunRecord record_run(FiniteElementLevel& level, const Scene& scene, const AfterStep& after_step) {
  const auto& plan = scene.training;
  Sampler sampler{
      std::max(1, scene.time.steps_per_period / plan.snapshots_per_period),
      static_cast<std::size_t>(plan.snapshots_per_period) * static_cast<std::size_t>(plan.sampled_periods),
      {}};
  const MPI_Comm comm = level.prepared().operators.comm;
  // A projection of a fixed domain needs the periodic state, and not its mean flow alone.
  Scene to_the_end = scene;
  if (scene.coupling == Coupling::fixed) to_the_end.time.flow_error = 0;
  State state = level.initial_state();
  PeriodicRun run = march_until_periodic(level, to_the_end, state, [&](const State& now, const Observation&) {
    if (after_step) after_step(comm);
    sampler.take(now);
  });
  RunRecord record = record_of(scene, std::move(run));
  sampler.write(level.prepared().disc, record);
  return record;
}

} // namespace undula::training
