#include "training/campaign/curve.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>

#include "fom/output/step_table.hpp"
#include "rom/base/error.hpp"
#include "rom/base/units.hpp"
#include "training/campaign/periodic_run.hpp"
#include "training/campaign/run_summary.hpp"
#include "training/training.hpp"

namespace undula::training {
namespace {

constexpr int averaged_unless_periodic = 3;

/// What two successive periods are compared by.
struct PeriodEnd {
  double mean_outflow = 0, rms_outflow = 0; ///< cm^3/s
  double largest_displacement = 0;          ///< cm, over the period
  Eigen::VectorXd displacement;             ///< cm, at its end
};

/// Change from one period to the next, as a part of what it is measured by; 0 for two periods of rest.
double relative_change(const PeriodEnd& now, const PeriodEnd& before) {
  const auto part = [](double change, double scale) { return change == 0 ? 0 : change / scale; };
  return std::max(
      part(std::abs(now.mean_outflow - before.mean_outflow), now.rms_outflow),
      part((now.displacement - before.displacement).lpNorm<Eigen::Infinity>(), now.largest_displacement));
}

/// Marches one period more, and adds its steps to `series`.
PeriodEnd march_period(const ThinGapModel& model, Scene& scene, State& state, TimeSeries& series,
                       PhaseTimer& timer) {
  const int steps = scene.time.steps_per_period;
  scene.time.periods = state.step / steps + 1;
  PeriodEnd end;
  march(model, scene, state, timer, [&](const State& now, const Observation& seen) {
    end.mean_outflow += seen.outflow / steps;
    end.rms_outflow += seen.outflow * seen.outflow / steps;
    end.largest_displacement = std::max(end.largest_displacement, now.d[0].lpNorm<Eigen::Infinity>());
    const auto row = observation_row(seen);
    series.steps.push_back(static_cast<int>(series.rows()) + 1); // counted from the first at this head
    series.values.insert(series.values.end(), row.begin(), row.end());
  });
  end.rms_outflow = std::sqrt(end.rms_outflow);
  end.displacement = state.d[0];
  return end;
}

/// Marches on from `state` at the head of `scene` until two periods agree.
RunRecord settle(const ThinGapModel& model, const Scene& scene, State& state) {
  const auto begin = std::chrono::steady_clock::now();
  PhaseTimer timer;
  RunRecord record;
  record.point = scene.operating_point;
  record.state = RunState::not_periodic;
  TimeSeries series{observation_columns(), {}, {}};
  Scene running = scene;
  const double ramp_end = scene.time.ramp_periods / scene.operating_point.frequency;
  double change = std::numeric_limits<double>::infinity();
  try {
    std::optional<PeriodEnd> before;
    for (int period = 1; period <= scene.time.periods; ++period) {
      // A period within the smooth start is no measure of the next one.
      const bool ramped = state.time < ramp_end - time_step(scene) / 2;
      PeriodEnd now = march_period(model, running, state, series, timer);
      if (before) change = relative_change(now, *before);
      if (change < scene.training.periodic_tolerance) {
        record.state = RunState::periodic;
        break;
      }
      before.reset();
      if (!ramped) before = std::move(now);
    }
    if (record.state == RunState::not_periodic)
      record.reason = "flow or displacement still change by " + std::to_string(change) + " over period " +
                      std::to_string(scene.time.periods) + " (tolerance " +
                      std::to_string(scene.training.periodic_tolerance) + ")";
  } catch (const NumericsError& error) {
    record.state = RunState::failed;
    record.reason = error.what();
  }
  complete_record(record, series, scene.time.steps_per_period, timer, begin);
  return record;
}

struct Settled {
  double head_mmHg = 0;
  State state;
};

/// Whether a head is near enough to two others, the second nearer, for a line through their states to help.
bool reaches(const Settled& first, const Settled& second, double head_mmHg) {
  constexpr double farthest = 1.5; // in distances of the two
  return head_mmHg - second.head_mmHg <= farthest * (second.head_mmHg - first.head_mmHg);
}

/// The state at `head_mmHg` on the line through two others, at the time of the second.
State extrapolate(const Settled& first, const Settled& second, double head_mmHg) {
  const double part = (head_mmHg - second.head_mmHg) / (second.head_mmHg - first.head_mmHg);
  State state = second.state;
  for (std::size_t level = 0; level < 2; ++level) {
    state.x[level] += part * (second.state.x[level] - first.state.x[level]);
    state.d[level] += part * (second.state.d[level] - first.state.d[level]);
  }
  return state;
}

Scene at_head(const Scene& scene, double head_mmHg) {
  Scene point = scene;
  point.operating_point.head = units::pressure_from_mmHg(head_mmHg);
  return point;
}

std::vector<CurvePoint> curve_of(PreparedScene& prepared, const Scene& scene,
                                 std::span<const double> heads_mmHg, const std::function<void()>& on_point) {
  std::vector<CurvePoint> points;
  for (const double head : heads_mmHg) {
    points.push_back(curve_point(periodic_run(prepared, at_head(scene, head))));
    if (on_point) on_point();
  }
  return points;
}

std::vector<CurvePoint> curve_of(const ThinGapModel& model, const Scene& scene,
                                 std::span<const double> heads_mmHg, const std::function<void()>& on_point) {
  std::vector<std::size_t> upwards(heads_mmHg.size());
  std::iota(upwards.begin(), upwards.end(), std::size_t{0});
  std::stable_sort(upwards.begin(), upwards.end(),
                   [&](std::size_t a, std::size_t b) { return heads_mmHg[a] < heads_mmHg[b]; });
  std::vector<CurvePoint> points(heads_mmHg.size());
  State state = initial_state(model);
  std::vector<Settled> settled; // the last two heads
  for (const std::size_t i : upwards) {
    const double head = heads_mmHg[i];
    const Scene point = at_head(scene, head);
    const bool extrapolated = settled.size() == 2 && reaches(settled[0], settled[1], head);
    if (extrapolated) state = extrapolate(settled[0], settled[1], head);
    RunRecord record = settle(model, point, state);
    if (extrapolated && record.state == RunState::failed) {
      state = settled.back().state;
      record = settle(model, point, state);
    }
    points[i] = curve_point(record, averaged_unless_periodic);
    if (on_point) on_point();
    if (record.state == RunState::failed) {
      state = initial_state(model);
      settled.clear();
      continue;
    }
    if (!settled.empty() && settled.back().head_mmHg == head) settled.pop_back();
    settled.push_back({head, state});
    if (settled.size() > 2) settled.erase(settled.begin());
  }
  return points;
}

} // namespace

CurvePoint curve_point(const RunRecord& record, int periods_averaged) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  CurvePoint point;
  point.head_mmHg = units::pressure_to_mmHg(record.point.head);
  point.periodic = record.state == RunState::periodic;
  point.reason = record.reason;
  point.seconds = record.seconds;
  const CycleMeans& cycles = record.cycles;
  const std::size_t periods = cycles.periods.size();
  point.periods = static_cast<int>(periods);
  point.flow_l_per_min = point.inflow_l_per_min = point.spread_l_per_min = point.power_mW =
      point.holder_power_mW = point.speed_max_cm_per_s = point.clearance_min_mm = unknown;
  if (record.state == RunState::failed || periods == 0) return point;

  const std::size_t averaged =
      point.periodic ? 1 : std::min(periods, static_cast<std::size_t>(periods_averaged));
  const auto column = [&](const char* name) {
    return static_cast<std::size_t>(std::find(cycles.columns.begin(), cycles.columns.end(), name) -
                                    cycles.columns.begin());
  };
  const auto last_of = [&](const std::vector<double>& values, const char* name) {
    std::vector<double> last;
    for (std::size_t period = periods - averaged; period < periods; ++period)
      last.push_back(values[period * cycles.columns.size() + column(name)]);
    return last;
  };
  const auto mean = [&](const char* name) {
    if (column(name) == cycles.columns.size()) return unknown;
    const auto last = last_of(cycles.mean, name);
    return std::accumulate(last.begin(), last.end(), 0.0) / static_cast<double>(averaged);
  };
  point.flow_l_per_min = mean("outflow_l_per_min");
  point.inflow_l_per_min = mean("inflow_l_per_min");
  point.spread_l_per_min = last_periods(cycles, "outflow_l_per_min").spread;
  point.power_mW = mean("hydraulic_power_mW");
  point.holder_power_mW = mean("holder_power_mW");
  point.speed_max_cm_per_s = std::ranges::max(last_of(cycles.maximum, "speed_max_cm_per_s"));
  point.clearance_min_mm = std::ranges::min(last_of(cycles.minimum, "clearance_min_mm"));
  return point;
}

std::vector<CurvePoint> head_flow_curve(PreparedLevel& level, const Scene& scene,
                                        std::span<const double> heads_mmHg,
                                        const std::function<void()>& on_point) {
  if (auto* prepared = std::get_if<std::unique_ptr<PreparedScene>>(&level))
    return curve_of(**prepared, scene, heads_mmHg, on_point);
  return curve_of(std::get<ThinGapModel>(level), scene, heads_mmHg, on_point);
}

std::vector<CurvePoint> head_flow_curve(const Scene& scene, std::span<const double> heads_mmHg, MPI_Comm comm,
                                        PhaseTimer& timer, const std::function<void()>& on_point) {
  auto level = prepare_level(scene, comm, timer);
  return head_flow_curve(level, scene, heads_mmHg, on_point);
}

} // namespace undula::training
