#include "training/study/run_study.hpp"

#include <chrono>
#include <cmath>

#include "fom/levels/curve_quantities.hpp"
#include "fom/levels/marched_curve.hpp"
#include "fom/output/series_statistics.hpp"
#include "fom/output/step_table.hpp"
#include "rom/base/error.hpp"
#include "rom/base/units.hpp"
#include "training/campaign/rank_groups.hpp"

namespace undula::training {
namespace {

const char* name_of(RunState state) {
  switch (state) {
    case RunState::periodic:
      return "periodic";
    case RunState::settled:
      return "settled";
    case RunState::not_periodic:
      return "not periodic";
    case RunState::failed:
      break;
  }
  return "failed";
}

/// A pump, until it repeats.
void run_pump(MarchingLevel& level, const Scene& scene, MPI_Comm group, const AfterStep& after_step,
              StudyRecord& record) {
  State state = level.initial_state();
  const PeriodicRun run = march_until_periodic(level, scene, state, [&](const State&, const Observation&) {
    if (after_step) after_step(group);
  });
  record.state = name_of(run.state);
  record.reason = run.reason;
  if (run.state == RunState::failed) return;
  const CurvePoint point = curve_point(run, units::pressure_to_mmHg(scene.operating_point.head));
  for (const CurveQuantity& quantity : curve_quantities)
    if (std::isfinite(point.*quantity.value))
      record.quantities.push_back({quantity.name, point.*quantity.value});
}

/// Any other scene, to its end.
void run_to_end(MarchingLevel& level, const Scene& scene, MPI_Comm group, PhaseTimer& timer,
                const AfterStep& after_step, StudyRecord& record) {
  const RowLayout rows = level.view(scene).rows;
  TimeSeries series{observation_columns(rows), {}, {}};
  State state = level.initial_state();
  march(level, scene, state, timer, [&](const State& now, const Observation& seen) {
    series.steps.push_back(now.step);
    const auto row = observation_row(seen, rows);
    series.values.insert(series.values.end(), row.begin(), row.end());
    if (after_step) after_step(group);
  });
  record.state = "ended";
  for (const ColumnStatistics& one : series_statistics(series, scene.output.statistics_from)) {
    record.quantities.push_back({"mean_" + one.column, one.mean});
    record.quantities.push_back({"amplitude_" + one.column, one.amplitude});
    record.quantities.push_back({"last_" + one.column, one.last});
  }
}

std::string on_one_line(std::string text) {
  for (std::size_t at = text.find("\n  "); at != std::string::npos; at = text.find("\n  "))
    text.replace(at, 3, "; ");
  return text;
}

StudyRecord run_point(const std::vector<double>& values, const SceneAtValues& scene_at, MPI_Comm group,
                      const AfterStep& after_step) {
  const auto begin = std::chrono::steady_clock::now();
  StudyRecord record;
  record.values = values;
  try {
    const Scene scene = scene_at(values);
    PhaseTimer timer;
    const auto level = prepare_level(scene, group, timer);
    if (scene.problem.general)
      run_to_end(*level, scene, group, timer, after_step, record);
    else
      run_pump(*level, scene, group, after_step, record);
  } catch (const InputError& error) {
    record.state = "refused";
    record.reason = on_one_line(error.what());
  } catch (const NumericsError& error) {
    record.state = "failed";
    record.reason = on_one_line(error.what());
  }
  if (record.state == "refused" || record.state == "failed") record.quantities.clear();
  record.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return record;
}

} // namespace

void run_study(const StudyPlan& plan, const SceneAtValues& scene_at, const StudyStore& store,
               int ranks_per_run, MPI_Comm world, const StudyProgress& progress,
               const AfterStep& after_step) {
  const RankGroup group(world, ranks_per_run);
  const auto next = [&]() -> std::optional<std::pair<RecordClaim, int>> {
    for (std::size_t i = 0; i < plan.points.size(); ++i)
      if (auto claim = store.try_claim(plan.points[i]))
        return std::pair(std::move(*claim), static_cast<int>(i));
    return std::nullopt;
  };
  work_off<RecordClaim>(group, next, [&](int number, const RecordClaim* claim) {
    const StudyRecord record =
        run_point(plan.points[static_cast<std::size_t>(number)], scene_at, group, after_step);
    if (claim == nullptr) return;
    store.store(*claim, record);
    if (progress) progress(record, plan.points.size() - store.pending(plan).size(), plan.points.size());
  });
}

} // namespace undula::training
