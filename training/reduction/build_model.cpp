#include "training/reduction/build_model.hpp"

#include <algorithm>

#include "rom/base/error.hpp"
#include "rom/base/units.hpp"
#include "training/campaign/check_record.hpp"
#include "training/campaign/recorded_run.hpp"
#include "training/reduction/drawn_bases.hpp"
#include "training/reduction/projection.hpp"

namespace undula::training {

namespace {

/// Shares of the full basis sizes at which the table of modes is made.
constexpr double mode_fractions[] = {0.25, 0.5, 0.75, 1.0};

std::vector<RunRecord> periodic_runs(std::span<const OperatingPoint> points, const CampaignStore& store,
                                     std::vector<std::string>& left_out) {
  std::vector<RunRecord> runs;
  for (const auto& point : points) {
    auto run = store.load(point);
    if (run.state == RunState::periodic) {
      runs.push_back(std::move(run));
      continue;
    }
    left_out.push_back(std::to_string(point.frequency) + " Hz, " +
                       std::to_string(units::length_to_mm(point.stroke)) + " mm, " +
                       std::to_string(units::pressure_to_mmHg(point.head)) + " mmHg: " + run.reason);
  }
  return runs;
}

/// Records of one campaign fit one discretisation and one plan.
void check_fits(const RunRecord& run, const PreparedScene& prepared, const Scene& scene,
                const std::string& file) {
  const auto& disc = prepared.disc;
  const auto columns = static_cast<std::size_t>(scene.training.snapshots_per_period) *
                       static_cast<std::size_t>(scene.training.sampled_periods);
  if (run.times.size() != columns)
    refuse_record("times of snapshots", std::to_string(run.times.size()), std::to_string(columns), file);
  check_fields(run,
               {{velocity_field, velocity_unknowns(disc).size()},
                {pressure_field, pressure_unknowns(disc).size()},
                {displacement_field, displacement_unknowns(disc).size()}},
               file);
  if (!run.seconds.contains("total"))
    refuse_record("wall time", "no \"total\"", "the seconds of the whole run", file);
}

rom::TrainingBox box_of(const TrainingPlan& plan) {
  return {plan.frequency_low,
          plan.frequency_high,
          units::length_to_mm(plan.stroke_low),
          units::length_to_mm(plan.stroke_high),
          units::pressure_to_mmHg(plan.head_low),
          units::pressure_to_mmHg(plan.head_high)};
}

} // namespace

TrainedModel build_model(const Scene& scene, const SamplingPlan& plan, const CampaignStore& store,
                         PhaseTimer& timer, bool with_fields) {
  TrainedModel trained;
  const auto training = periodic_runs(plan.training, store, trained.left_out);
  const auto held_out = periodic_runs(plan.held_out, store, trained.left_out);
  if (training.empty())
    throw InputError("no training run reached a periodic state",
                     std::to_string(plan.training.size()) + " runs", "at least one",
                     "section [training] of the scene: a smaller box, or time.periods");
  const auto prepared = prepare_scene(scene, MPI_COMM_SELF, timer);
  for (const auto* runs : {&training, &held_out})
    for (const auto& run : *runs) check_fits(run, *prepared, scene, store.record_file(run.point).string());
  Bases bases;
  {
    const auto scope = timer.measure("basis");
    bases = build_bases(*prepared, scene, training);
  }
  {
    const auto scope = timer.measure("project");
    trained.model.operators = project(*prepared, bases);
  }
  if (with_fields) trained.fields = drawn_bases(prepared->disc, bases);
  trained.model.steps_per_period = scene.time.steps_per_period;
  trained.model.box = box_of(scene.training);
  trained.captured_velocity = bases.captured_velocity;
  trained.captured_pressure = bases.captured_pressure;
  trained.captured_displacement = bases.captured_displacement;

  const auto scope = timer.measure("judge");
  for (const auto& run : training) trained.runs.push_back(project_run(*prepared, scene, bases, run, false));
  for (const auto& run : held_out) trained.runs.push_back(project_run(*prepared, scene, bases, run, true));
  const auto [low, high] = std::minmax_element(trained.runs.begin(), trained.runs.end(),
                                               [](const auto& a, const auto& b) { return a.flow < b.flow; });
  trained.flow_range = high->flow - low->flow;
  trained.modes =
      mode_table(trained.model.operators, scene.time.steps_per_period, trained.runs, mode_fractions);
  calibrate_model(trained.model, trained.runs);
  return trained;
}

} // namespace undula::training
