#include "training/moving_domain/build_moving_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fom/levels/moving_reduced_level.hpp"
#include "fom/scene/scene_file.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"
#include "training/campaign/recorded_level.hpp"
#include "training/emulation/quantile.hpp"

namespace undula::training {
namespace {

rom::MovingRun moving_run(const Scene& scene, const RunRecord& record, bool held_out) {
  const CurvePoint point = curve_point_of(scene, record);
  rom::MovingRun run;
  run.frequency_Hz = record.point.frequency;
  run.voltage_V = record.point.voltage;
  run.head_mmHg = point.head_mmHg;
  run.held_out = held_out;
  run.flow_l_per_min = point.flow_l_per_min;
  run.standard_error_l_per_min = point.periodic ? 0 : point.standard_error_l_per_min;
  run.stroke_mm = point.stroke_mm;
  if (const auto total = record.seconds.find("total"); total != record.seconds.end())
    run.fom_seconds = total->second;
  run.rom_flow_l_per_min = std::numeric_limits<double>::quiet_NaN();
  return run;
}

/// Runs of `points` that have not failed; those that have are told.
std::vector<RunRecord> runs_of(const std::vector<OperatingPoint>& points, const CampaignStore& store,
                               std::vector<std::string>& left_out) {
  std::vector<RunRecord> runs;
  for (const auto& at : points) {
    auto record = store.load(at);
    if (record.state == RunState::failed)
      left_out.push_back(store.record_file(at).filename().string() + ": " + record.reason);
    else
      runs.push_back(std::move(record));
  }
  return runs;
}

void ask_model(rom::MovingModel& model, const std::string& name) {
  PhaseTimer timer;
  MovingReducedLevel level(model, name, MPI_COMM_SELF, timer);
  for (auto& run : model.runs) {
    if (!run.held_out) continue;
    const Scene scene = scene_of_moving_model(model, name, run.frequency_Hz, {{}, run.voltage_V});
    const double head = run.head_mmHg;
    const auto point = level.curve(scene, std::span(&head, 1)).front();
    run.rom_flow_l_per_min = point.flow_l_per_min;
    run.rom_standard_error_l_per_min = point.periodic ? 0 : point.standard_error_l_per_min;
    run.rom_stroke_mm = point.stroke_mm;
    run.rom_seconds = point.seconds.at("total");
  }
}

double stated_error(const std::vector<rom::MovingRun>& runs) {
  std::vector<double> errors;
  for (const auto& run : runs)
    if (run.held_out)
      errors.push_back(std::isfinite(run.rom_flow_l_per_min)
                           ? std::abs(run.rom_flow_l_per_min - run.flow_l_per_min)
                           : std::numeric_limits<double>::infinity());
  return errors.empty() ? std::numeric_limits<double>::infinity() : quantile(errors, nine_in_ten);
}

} // namespace

BuiltMovingModel build_moving_model(const Scene& scene, const SamplingPlan& plan, const CampaignStore& store,
                                    PhaseTimer& timer) {
  BuiltMovingModel built;
  const auto training = runs_of(plan.training, store, built.left_out);
  const auto held_out = runs_of(plan.held_out, store, built.left_out);
  if (training.empty())
    throw InputError("no training run ended", std::to_string(plan.training.size()) + " failed runs",
                     "at least one", "section [training] of the scene");
  const auto prepared = prepare_scene(scene, MPI_COMM_SELF, timer);
  for (const auto& run : training)
    check_moving_record(prepared->disc, scene, run, store.record_file(run.point).string());
  auto& model = built.model;
  {
    const auto scope = timer.measure("basis");
    built.bases = build_moving_bases(*prepared, scene, training);
  }
  model.basis = built.bases.basis;
  model.pressure_modes = built.bases.pressure;
  if (scene.training.cubature_error > 0) {
    const auto scope = timer.measure("cubature");
    built.cubature = choose_cubature(*prepared, scene, model.basis, model.pressure_modes, training,
                                     scene.training.cubature_error);
    model.part_weights = built.cubature.part_weights;
    model.cell_weights = built.cubature.cell_weights;
  }
  model.scene = scene_to_toml(scene);
  model.profile = read_text_file(scene.profile);
  const auto& box = scene.training;
  model.box = {box.frequency_low,
               box.frequency_high,
               box.voltage_low,
               box.voltage_high,
               units::pressure_to_mmHg(box.head_low),
               units::pressure_to_mmHg(box.head_high)};
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const auto* runs : {&training, &held_out})
    for (const auto& record : *runs) {
      model.runs.push_back(moving_run(scene, record, runs == &held_out));
      low = std::min(low, model.runs.back().flow_l_per_min);
      high = std::max(high, model.runs.back().flow_l_per_min);
    }
  built.flow_range_l_per_min = high - low;
  {
    const auto scope = timer.measure("judge");
    ask_model(model, "the model just made");
  }
  model.error_l_per_min = stated_error(model.runs);
  for (const auto& [phase, entry] : timer.records()) built.seconds[phase] = entry.seconds;
  return built;
}

} // namespace undula::training
