#include "fom/levels/marched_curve.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

#include "fom/output/blood_stress.hpp"
#include "fom/output/last_periods.hpp"
#include "fom/output/settled_mean.hpp"
#include "rom/base/units.hpp"

namespace undula::fom {
namespace {

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

std::vector<std::size_t> upwards(std::span<const double> heads_mmHg) {
  std::vector<std::size_t> order(heads_mmHg.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return heads_mmHg[a] < heads_mmHg[b]; });
  return order;
}

std::vector<CurvePoint> curve_from_head_to_head(MarchingLevel& level, const Scene& scene,
                                                std::span<const double> heads_mmHg,
                                                const std::function<void()>& on_point) {
  std::vector<CurvePoint> points(heads_mmHg.size());
  State state = level.initial_state();
  std::vector<Settled> settled; // the last two heads
  for (const std::size_t i : upwards(heads_mmHg)) {
    const double head = heads_mmHg[i];
    const Scene point = at_head(scene, head);
    const bool extrapolated = settled.size() == 2 && reaches(settled[0], settled[1], head);
    if (extrapolated) state = extrapolate(settled[0], settled[1], head);
    PeriodicRun run = march_until_periodic(level, point, state);
    if (extrapolated && run.state == RunState::failed) {
      state = settled.back().state;
      run = march_until_periodic(level, point, state);
    }
    points[i] = curve_point(run, head);
    if (on_point) on_point();
    if (run.state == RunState::failed) {
      state = level.initial_state();
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

CurvePoint curve_point(const PeriodicRun& run, double head_mmHg) {
  CurvePoint point;
  point.head_mmHg = head_mmHg;
  point.periodic = run.state == RunState::periodic;
  point.reason = run.reason;
  point.seconds = run.seconds;
  const CycleMeans& cycles = run.cycles;
  const std::size_t periods = cycles.periods.size();
  point.periods = static_cast<int>(periods);
  if (run.state == RunState::failed || periods == 0) return point;

  // Of a state that does not repeat, the periods that its transient leaves.
  const auto flows = period_means(cycles, "outflow_l_per_min");
  const auto plain = std::min(periods, static_cast<std::size_t>(std::max(run.plain_periods, 1)));
  const SettledMean settled = settled_mean(std::span(flows).last(plain));
  const std::size_t averaged = point.periodic ? 1 : static_cast<std::size_t>(settled.counted);
  const auto last_of = [&](const std::vector<double>& values, const char* name) {
    const auto column = static_cast<std::size_t>(
        std::find(cycles.columns.begin(), cycles.columns.end(), name) - cycles.columns.begin());
    std::vector<double> last;
    for (std::size_t period = periods - averaged; period < periods && column < cycles.columns.size();
         ++period)
      last.push_back(values[period * cycles.columns.size() + column]);
    return last;
  };
  const auto mean = [&](const char* name) {
    const auto last = last_of(cycles.mean, name);
    return last.empty() ? CurvePoint::unknown
                        : std::accumulate(last.begin(), last.end(), 0.0) / static_cast<double>(averaged);
  };
  point.flow_l_per_min = mean("outflow_l_per_min");
  point.inflow_l_per_min = mean("inflow_l_per_min");
  point.spread_l_per_min = point.periodic ? last_periods(cycles, "outflow_l_per_min").spread : settled.spread;
  if (!point.periodic) {
    point.standard_error_l_per_min = settled.standard_error;
    point.averaged_periods = settled.counted;
  }
  point.power_mW = mean("hydraulic_power_mW");
  point.holder_power_mW = mean("holder_power_mW");
  const double torque = mean("torque_N_m");
  const bool rollers = std::isfinite(torque);
  // Phasors: a sin + b cos is the imaginary part of (a + i b) exp(i phase).
  const std::complex<double> holder(mean("holder_sine_mm"), mean("holder_cosine_mm"));
  const std::complex<double> force(mean("holder_force_sine_N"), mean("holder_force_cosine_N"));
  const std::complex<double> second(mean("holder_sine_2f_mm"), mean("holder_cosine_2f_mm")),
      third(mean("holder_sine_3f_mm"), mean("holder_cosine_3f_mm"));
  if (!rollers) {
    point.stroke_mm = std::abs(holder);
    point.stroke_2f_mm = std::abs(second);
    point.stroke_3f_mm = std::abs(third);
    point.offset_mm = mean("holder_mm");
  }
  if (point.stroke_mm > 0) {
    constexpr double degrees = 180 / std::numbers::pi;
    point.phase_degrees = -std::arg(holder) * degrees;
    point.phase_2f_degrees = -std::arg(second) * degrees;
    point.phase_3f_degrees = -std::arg(third) * degrees;
    if (std::abs(force) > 0) {
      point.reaction_in_phase_N_per_mm = (force / holder).real();
      point.reaction_quadrature_N_per_mm = (force / holder).imag();
    }
  }
  if (const double power = mean("actuator_power_mW"); power != 0) point.actuator_power_mW = power;
  if (const double power = mean("electrical_power_mW"); power != 0) point.electrical_power_mW = power;
  point.efficiency_percent = efficiency_percent(point);
  point.speed_max_cm_per_s = std::ranges::max(last_of(cycles.maximum, "speed_max_cm_per_s"));
  if (const double rate = mean("damage_rate_cm3_per_s"); std::isfinite(rate)) {
    point.haemolysis_percent =
        haemolysis_percent(run.blood, rate, units::flow_from_l_per_min(point.flow_l_per_min));
    point.scalar_stress_max_Pa = std::ranges::max(last_of(cycles.maximum, "scalar_stress_max_Pa"));
    point.stressed_volume_mm3 = mean("stressed_volume_mm3");
  }
  if (rollers) {
    const auto outflow_low = last_of(cycles.minimum, "outflow_l_per_min"),
               outflow_high = last_of(cycles.maximum, "outflow_l_per_min");
    point.flow_per_turn_ml = units::flow_from_l_per_min(point.flow_l_per_min) * run.period; // 1 ml is 1 cm^3
    point.ripple_l_per_min = std::ranges::max(outflow_high) - std::ranges::min(outflow_low);
    point.leak_l_per_min = mean("leak_l_per_min");
    point.torque_N_m = torque;
    point.torque_max_N_m = std::ranges::max(last_of(cycles.maximum, "torque_N_m"));
    point.roller_force_max_N = std::ranges::max(last_of(cycles.maximum, "roller_force_N"));
    point.outlet_pressure_min_mmHg = std::ranges::min(last_of(cycles.minimum, "outlet_pressure_mmHg"));
    point.outlet_pressure_max_mmHg = std::ranges::max(last_of(cycles.maximum, "outlet_pressure_mmHg"));
  }
  point.film_unresolved_percent = 100 * mean("film_unresolved");
  if (std::isfinite(point.film_unresolved_percent))
    point.film_elements_min = std::ranges::min(last_of(cycles.minimum, "film_elements"));
  point.clearance_min_mm = std::ranges::min(last_of(cycles.minimum, "clearance_min_mm"));
  return point;
}

std::vector<CurvePoint> marched_curve(MarchingLevel& level, const Scene& scene,
                                      std::span<const double> heads_mmHg,
                                      const std::function<void()>& on_point) {
  if (level.goes_from_head_to_head()) return curve_from_head_to_head(level, scene, heads_mmHg, on_point);
  std::vector<CurvePoint> points;
  for (const double head : heads_mmHg) {
    State state = level.initial_state();
    points.push_back(curve_point(march_until_periodic(level, at_head(scene, head), state), head));
    if (on_point) on_point();
  }
  return points;
}

} // namespace undula::fom
