#include "training/campaign/periodic_run.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>

#include "rom/base/error.hpp"
#include "rom/base/units.hpp"

namespace undula::training {

namespace {

// Extrapolation looks back over so many periods. More bring in the noise of fast modes.
constexpr std::size_t extrapolation_window = 4;
// An extrapolated state is kept if the next period changes less than this factor times the change before it.
constexpr double accepted_growth = 2.0;

State combine(const std::deque<State>& states, const Eigen::VectorXd& weights) {
  State sum = states.back();
  for (std::size_t level = 0; level < 2; ++level) {
    sum.x[level].setZero();
    sum.d[level].setZero();
    for (Eigen::Index i = 0; i < weights.size(); ++i) {
      const auto& state = states[static_cast<std::size_t>(i) + 1];
      sum.x[level] += weights[i] * state.x[level];
      sum.d[level] += weights[i] * state.d[level];
    }
  }
  return sum;
}

Eigen::VectorXd select(const Eigen::VectorXd& x, const std::vector<int>& unknowns) { return x(unknowns); }

TimeSeries empty_series() {
  TimeSeries series;
  series.columns = {"outflow_l_per_min", "inflow_l_per_min",   "hydraulic_power_mW",
                    "holder_power_mW",   "speed_max_cm_per_s", "clearance_min_mm"};
  return series;
}

void append(TimeSeries& series, const Observation& seen) {
  constexpr double mW_per_erg_per_s = 1e-4;
  series.steps.push_back(seen.step);
  for (const double value : {units::flow_to_l_per_min(seen.outflow), units::flow_to_l_per_min(seen.inflow),
                             seen.hydraulic_power * mW_per_erg_per_s, seen.energy.holder * mW_per_erg_per_s,
                             seen.speed_max, units::length_to_mm(seen.clearance_min)})
    series.values.push_back(value);
}

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
    kept.emplace_back(state.time, std::move(copy));
    if (kept.size() > capacity) kept.pop_front();
  }

  void write(const Discretisation<2>& disc, RunRecord& record) const {
    const auto store = [&](const char* field, const char* unit, const std::vector<int>& unknowns,
                           bool displacement) {
      Snapshots snapshots;
      snapshots.unit = unit;
      snapshots.values.resize(static_cast<Eigen::Index>(unknowns.size()),
                              static_cast<Eigen::Index>(kept.size()));
      for (std::size_t k = 0; k < kept.size(); ++k)
        snapshots.values.col(static_cast<Eigen::Index>(k)) =
            select(displacement ? kept[k].second.d[0] : kept[k].second.x[0], unknowns);
      record.snapshots.emplace(field, std::move(snapshots));
    };
    store(velocity_field, "cm/s", velocity_unknowns(disc), false);
    store(pressure_field, "dyn/cm^2", pressure_unknowns(disc), false);
    store(displacement_field, "cm", displacement_unknowns(disc), true);
    for (const auto& [time, state] : kept) record.times.push_back(time);
  }
};

} // namespace

std::vector<int> velocity_unknowns(const Discretisation<2>& disc) {
  std::vector<int> unknowns;
  for (std::size_t node = 0; node < disc.fluid_nodes.dof_point.size(); ++node)
    for (int c = 0; c < 2; ++c) unknowns.push_back(disc.velocity_unknown(static_cast<int>(node), c));
  return unknowns;
}

std::vector<int> pressure_unknowns(const Discretisation<2>& disc) {
  std::vector<int> unknowns;
  for (std::size_t node = 0; node < disc.fluid_nodes.dof_point.size(); ++node)
    unknowns.push_back(disc.pressure_unknown(static_cast<int>(node)));
  return unknowns;
}

std::vector<int> displacement_unknowns(const Discretisation<2>& disc) {
  std::vector<int> unknowns;
  for (int unknown = disc.fluid_unknowns(); unknown < disc.unknowns(); ++unknown) unknowns.push_back(unknown);
  return unknowns;
}

Eigen::VectorXd extrapolation_weights(const Eigen::MatrixXd& differences) {
  // Minimise over gamma with sum 1 by eliminating the last weight.
  const Eigen::Index m = differences.cols();
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(m);
  if (m == 1) {
    weights[0] = 1;
    return weights;
  }
  const Eigen::MatrixXd reduced = differences.leftCols(m - 1).colwise() - differences.col(m - 1);
  const Eigen::VectorXd free = reduced.colPivHouseholderQr().solve(-differences.col(m - 1));
  weights.head(m - 1) = free;
  weights[m - 1] = 1 - free.sum();
  return weights;
}

void complete_record(RunRecord& record, const TimeSeries& series, int steps_per_period,
                     const PhaseTimer& timer, std::chrono::steady_clock::time_point begin) {
  record.cycles = summarise_cycles(series, steps_per_period);
  for (const auto& [phase, entry] : timer.records()) record.seconds[phase] = entry.seconds;
  record.seconds["total"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

RunRecord periodic_run(PreparedScene& prepared, const Scene& scene, const AfterStep& after_step) {
  const auto begin = std::chrono::steady_clock::now();
  const auto& disc = prepared.disc;
  set_operating_point(prepared, scene);
  PhaseTimer timer;
  RunRecord record;
  record.point = scene.operating_point;
  TimeSeries series = empty_series();
  Sampler sampler{
      std::max(1, scene.time.steps_per_period / scene.training.snapshots_per_period),
      static_cast<std::size_t>(scene.training.snapshots_per_period * scene.training.sampled_periods),
      {}};

  // Velocity and displacement are each measured in the mass: a membrane that creeps by a little every period
  // has a small velocity all along, and only its displacement tells.
  const auto mass_norm = [&](const Eigen::VectorXd& x) {
    Eigen::VectorXd square(1);
    square[0] = x.dot(prepared.operators.mass * x);
    sum_over_ranks(prepared.operators.comm, square);
    return std::sqrt(square[0]);
  };
  const auto relative_change = [&](const Eigen::VectorXd& now, const Eigen::VectorXd& before) {
    return mass_norm(now - before) / std::max(mass_norm(now), 1e-300);
  };
  Eigen::VectorXd root_mass = prepared.operators.mass.diagonal();
  sum_over_ranks(prepared.operators.comm, root_mass);
  root_mass = root_mass.cwiseMax(0.0).cwiseSqrt();

  State state = initial_state(disc);
  std::deque<State> ends; // of the last periods, plainly marched one after the other
  State before_extrapolation;
  double change = 1, change_before = 1;
  bool just_extrapolated = false, may_extrapolate = true;
  int plain_periods = 0;
  record.state = RunState::not_periodic;
  try {
    // One stepper for all periods: march() is called once, and extrapolation would have to interrupt it.
    TimeStepper<2> stepper(disc, prepared.operators, scene.time.scheme, time_step(scene),
                           scene.time.factor_every, timer);
    const int ramp = static_cast<int>(std::ceil(scene.time.ramp_periods));
    for (int period = 1; period <= scene.time.periods; ++period) {
      const Eigen::VectorXd start_x = state.x[0], start_d = state.d[0];
      for (int k = 0; k < scene.time.steps_per_period; ++k) {
        stepper.advance(state);
        if (after_step) after_step(prepared.operators.comm);
        append(series, observe(disc, prepared.operators, stepper, prepared.observation, state));
        sampler.take(state);
      }
      ++plain_periods;
      change = std::max(relative_change(state.x[0], start_x), relative_change(state.d[0], start_d));
      if (period <= ramp) continue;
      // The sampled periods must follow one another without a jump.
      if (change < scene.training.periodic_tolerance && plain_periods >= scene.training.sampled_periods) {
        record.state = RunState::periodic;
        break;
      }
      if (just_extrapolated) {
        just_extrapolated = false;
        if (change > accepted_growth * change_before) {
          const int step = state.step; // time goes on, the state goes back
          const double time = state.time;
          state = before_extrapolation;
          state.step = step;
          state.time = time;
          may_extrapolate = false;
          ends.clear();
          plain_periods = 0;
          continue;
        }
      }
      ends.push_back(state);
      if (ends.size() <= extrapolation_window) continue;
      if (may_extrapolate && period + 2 <= scene.time.periods) {
        // Coordinates in which velocity and displacement weigh the same.
        const double balance = mass_norm(state.x[0]) / std::max(mass_norm(state.d[0]), 1e-300);
        const Eigen::Index size = disc.unknowns();
        Eigen::MatrixXd differences(2 * size, static_cast<Eigen::Index>(extrapolation_window));
        for (std::size_t i = 0; i < extrapolation_window; ++i) {
          const auto column = static_cast<Eigen::Index>(i);
          differences.col(column).head(size) = root_mass.cwiseProduct(ends[i + 1].x[0] - ends[i].x[0]);
          differences.col(column).tail(size) =
              balance * root_mass.cwiseProduct(ends[i + 1].d[0] - ends[i].d[0]);
        }
        before_extrapolation = state;
        change_before = change;
        const int step = state.step;
        const double time = state.time;
        state = combine(ends, extrapolation_weights(differences));
        state.step = step;
        state.time = time;
        just_extrapolated = true;
        plain_periods = 0;
        ends.clear();
        ends.push_back(state);
      } else {
        ends.pop_front();
      }
    }
    if (record.state == RunState::not_periodic)
      record.reason = "the state still changes by " + std::to_string(change) + " over period " +
                      std::to_string(scene.time.periods) + " (tolerance " +
                      std::to_string(scene.training.periodic_tolerance) + ")";
  } catch (const NumericsError& error) {
    record.state = RunState::failed;
    record.reason = error.what();
  }
  sampler.write(disc, record);
  complete_record(record, series, scene.time.steps_per_period, timer, begin);
  return record;
}

} // namespace undula::training
