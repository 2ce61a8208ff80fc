#include "fom/levels/periodic_run.hpp"

#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

#include "fom/levels/period_check.hpp"
#include "fom/output/settled_mean.hpp"
#include "fom/scene/scene_time.hpp"
#include "rom/base/error.hpp"
#include "rom/base/units.hpp"

namespace undula::fom {
namespace {

constexpr double dyn_cm_per_N_m = 1e7;

/// 1 where the narrowest film has too few elements, else 0; NaN where that is not known.
double film_is_unresolved(const Observation& seen) {
  return std::isnan(seen.film_elements) ? seen.film_elements : !film_is_resolved(seen.film_elements);
}

double place_of(const Observation& seen) { return units::length_to_mm(seen.holder.displacement); }
double force_of(const Observation& seen) { return units::force_to_N(seen.holder.force); }

/// A number of the blood's stress; NaN where it is not observed.
template <double BloodStress::*member>
double blood_of(const Observation& seen) {
  return seen.blood ? (*seen.blood).*member : std::numeric_limits<double>::quiet_NaN();
}

/// A number of the hose; NaN of other pumps.
template <double HoseObservation::*member>
double hose_of(const Observation& seen) {
  return seen.hose ? (*seen.hose).*member : std::numeric_limits<double>::quiet_NaN();
}

/// What is averaged over a period, by the observation and the phase of the drive. The means of a signal times
/// 2 sin and 2 cos of n times the phase are the coefficients of its part at n times the frequency.
struct Column {
  const char* name;
  double (*value)(const Observation& seen, double phase);
};
constexpr Column columns[] = {
    {"outflow_l_per_min", [](const Observation& o, double) { return units::flow_to_l_per_min(o.outflow); }},
    {"inflow_l_per_min", [](const Observation& o, double) { return units::flow_to_l_per_min(o.inflow); }},
    {"hydraulic_power_mW",
     [](const Observation& o, double) { return units::power_to_mW(o.hydraulic_power); }},
    {"holder_power_mW", [](const Observation& o, double) { return units::power_to_mW(o.energy.holder); }},
    {"speed_max_cm_per_s", [](const Observation& o, double) { return o.speed_max; }},
    {"clearance_min_mm", [](const Observation& o, double) { return units::length_to_mm(o.clearance_min); }},
    {"holder_mm", [](const Observation& o, double) { return place_of(o); }},
    {"holder_sine_mm", [](const Observation& o, double p) { return place_of(o) * 2 * std::sin(p); }},
    {"holder_cosine_mm", [](const Observation& o, double p) { return place_of(o) * 2 * std::cos(p); }},
    {"holder_sine_2f_mm", [](const Observation& o, double p) { return place_of(o) * 2 * std::sin(2 * p); }},
    {"holder_cosine_2f_mm", [](const Observation& o, double p) { return place_of(o) * 2 * std::cos(2 * p); }},
    {"holder_sine_3f_mm", [](const Observation& o, double p) { return place_of(o) * 2 * std::sin(3 * p); }},
    {"holder_cosine_3f_mm", [](const Observation& o, double p) { return place_of(o) * 2 * std::cos(3 * p); }},
    {"holder_force_sine_N", [](const Observation& o, double p) { return force_of(o) * 2 * std::sin(p); }},
    {"holder_force_cosine_N", [](const Observation& o, double p) { return force_of(o) * 2 * std::cos(p); }},
    {"actuator_power_mW",
     [](const Observation& o, double) { return units::power_to_mW(o.holder.actuator_power); }},
    {"electrical_power_mW",
     [](const Observation& o, double) { return units::power_to_mW(o.holder.electrical_power); }},
    {"film_elements", [](const Observation& o, double) { return o.film_elements; }},
    {"film_unresolved", [](const Observation& o, double) { return film_is_unresolved(o); }},
    {"scalar_stress_max_Pa",
     [](const Observation& o, double) { return units::pressure_to_Pa(blood_of<&BloodStress::maximum>(o)); }},
    {"stressed_volume_mm3",
     [](const Observation& o, double) {
       return units::volume_to_mm3(blood_of<&BloodStress::stressed_volume>(o));
     }},
    {"damage_rate_cm3_per_s",
     [](const Observation& o, double) { return blood_of<&BloodStress::damage_rate>(o); }},
    {"torque_N_m",
     [](const Observation& o, double) { return hose_of<&HoseObservation::torque>(o) / dyn_cm_per_N_m; }},
    {"leak_l_per_min", [](const Observation& o,
                          double) { return units::flow_to_l_per_min(hose_of<&HoseObservation::leak>(o)); }},
    {"outlet_pressure_mmHg",
     [](const Observation& o, double) {
       return units::pressure_to_mmHg(hose_of<&HoseObservation::outlet_pressure>(o));
     }},
    {"roller_force_N", [](const Observation& o,
                          double) { return units::force_to_N(hose_of<&HoseObservation::roller_force>(o)); }},
};

/// Steps are counted from the first of this march.
void append(TimeSeries& series, const Observation& seen, double frequency) {
  series.steps.push_back(static_cast<int>(series.rows()) + 1);
  const double phase = 2 * std::numbers::pi * frequency * seen.time;
  for (const Column& column : columns) series.values.push_back(column.value(seen, phase));
}

} // namespace

std::vector<std::string> cycle_columns() {
  std::vector<std::string> names;
  for (const Column& column : columns) names.emplace_back(column.name);
  return names;
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
    std::vector<double> flows; // l/min, of the periods marched plainly since the smooth start
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
      if (!ramped) flows.push_back(outflow);
      ++run.plain_periods;
      if (check->end(period, ramped, state))
        run.state = RunState::periodic;
      else if (check->replaced())
        flows.clear();
      else if (flow_is_known(scene, flows))
        run.state = RunState::settled;
      if (check->replaced() && period < scene.time.periods) run.plain_periods = 0;
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
  run.period = 1 / scene.operating_point.frequency;
  for (const auto& [phase, entry] : timer.records()) run.seconds[phase] = entry.seconds;
  run.seconds["total"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return run;
}

} // namespace undula::fom
