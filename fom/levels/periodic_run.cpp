#include "fom/levels/periodic_run.hpp"

#include <chrono>
#include <cmath>
#include <numbers>

#include "fom/levels/period_check.hpp"
#include "fom/output/settled_mean.hpp"
#include "fom/scene/scene_time.hpp"
#include "rom/base/error.hpp"
#include "rom/base/units.hpp"

namespace undula::fom {
namespace {

/// 1 where the narrowest film has too few elements, else 0; NaN where that is not known.
double film_is_unresolved(const Observation& seen) {
  return std::isnan(seen.film_elements) ? seen.film_elements : seen.film_elements < resolved_film_elements;
}

/// Steps are counted from the first of this march. The means of a signal times 2 sin and 2 cos of n times the
/// drive's phase are the coefficients of its part at n times the frequency.
void append(TimeSeries& series, const Observation& seen, double frequency) {
  series.steps.push_back(static_cast<int>(series.rows()) + 1);
  const double phase = 2 * std::numbers::pi * frequency * seen.time;
  const double sine = 2 * std::sin(phase), cosine = 2 * std::cos(phase);
  const double place = units::length_to_mm(seen.holder.displacement),
               force = units::force_to_N(seen.holder.force);
  for (const double value : {units::flow_to_l_per_min(seen.outflow),
                             units::flow_to_l_per_min(seen.inflow),
                             units::power_to_mW(seen.hydraulic_power),
                             units::power_to_mW(seen.energy.holder),
                             seen.speed_max,
                             units::length_to_mm(seen.clearance_min),
                             place,
                             place * sine,
                             place * cosine,
                             place * 2 * std::sin(2 * phase),
                             place * 2 * std::cos(2 * phase),
                             place * 2 * std::sin(3 * phase),
                             place * 2 * std::cos(3 * phase),
                             force * sine,
                             force * cosine,
                             units::power_to_mW(seen.holder.actuator_power),
                             units::power_to_mW(seen.holder.electrical_power),
                             seen.film_elements,
                             film_is_unresolved(seen),
                             units::pressure_to_Pa(seen.blood.maximum),
                             units::volume_to_mm3(seen.blood.stressed_volume),
                             seen.blood.damage_rate})
    series.values.push_back(value);
}

} // namespace

std::vector<std::string> cycle_columns() {
  return {"outflow_l_per_min",
          "inflow_l_per_min",
          "hydraulic_power_mW",
          "holder_power_mW",
          "speed_max_cm_per_s",
          "clearance_min_mm",
          "holder_mm",
          "holder_sine_mm",
          "holder_cosine_mm",
          "holder_sine_2f_mm",
          "holder_cosine_2f_mm",
          "holder_sine_3f_mm",
          "holder_cosine_3f_mm",
          "holder_force_sine_N",
          "holder_force_cosine_N",
          "actuator_power_mW",
          "electrical_power_mW",
          "film_elements",
          "film_unresolved",
          "scalar_stress_max_Pa",
          "stressed_volume_mm3",
          "damage_rate_cm3_per_s"};
}

bool flow_is_known(const Scene& scene, std::span<const double> flows_l_per_min) {
  constexpr int fewest = 6;
  if (scene.time.flow_error <= 0) return false;
  const auto settled = settled_mean(flows_l_per_min);
  return settled.counted >= fewest &&
         settled.standard_error <= units::flow_to_l_per_min(scene.time.flow_error);
}

PeriodicRun march_until_periodic(MarchingLevel& level, const Scene& scene, State& state,
                                 const StepCallback& on_step) {
  const auto begin = std::chrono::steady_clock::now();
  const int steps = scene.time.steps_per_period;
  const double ramp_end = scene.time.ramp_periods / scene.operating_point.frequency;
  PhaseTimer timer;
  PeriodicRun run;
  run.state = RunState::not_periodic;
  TimeSeries series{cycle_columns(), {}, {}};
  const auto check = period_check(level, scene);
  try {
    const auto marcher = level.start(scene, state, timer);
    std::vector<double> flows; // l/min, by period
    for (int period = 1; period <= scene.time.periods && run.state == RunState::not_periodic; ++period) {
      const bool ramped = state.time < ramp_end - time_step(scene) / 2;
      check->begin(state);
      double outflow = 0;
      march_to(*marcher, state.step + steps, state, [&](const State& now, const Observation& seen) {
        append(series, seen, scene.operating_point.frequency);
        check->step(now, seen);
        outflow += units::flow_to_l_per_min(seen.outflow) / steps;
        if (on_step) on_step(now, seen);
      });
      flows.push_back(outflow);
      if (check->end(period, ramped, state))
        run.state = RunState::periodic;
      else if (flow_is_known(scene, flows))
        run.state = RunState::settled;
    }
    if (run.state == RunState::settled) run.reason = check->left() + ", and the mean flow is known";
    if (run.state == RunState::not_periodic)
      run.reason = check->left() + " over period " + std::to_string(scene.time.periods) + " (tolerance " +
                   std::to_string(scene.training.periodic_tolerance) + ")";
  } catch (const NumericsError& error) {
    run.state = RunState::failed;
    run.reason = error.what();
  }
  run.cycles = summarise_cycles(series, steps);
  run.blood = scene.blood;
  for (const auto& [phase, entry] : timer.records()) run.seconds[phase] = entry.seconds;
  run.seconds["total"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return run;
}

} // namespace undula::fom
