#include "fom/thin_gap/thin_gap.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "fom/fom.hpp"
#include "fom/machines/wave_pump/pump_checks.hpp"
#include "fom/machines/wave_pump/pump_problem.hpp"
#include "fom/scene/scene_time.hpp"
#include "fom/thin_gap/step_energy.hpp"
#include "fom/thin_gap/step_equations.hpp"
#include "geometry/wave_pump/pump.hpp"
#include "rom/base/error.hpp"

namespace undula::fom {

namespace {

constexpr int max_iterations = 40;
constexpr int full_iterations = 8; // of Newton, before its updates are shortened
constexpr double shortening = 0.5;
constexpr double slow_convergence = 0.1; // ratio of changes at which the matrix is made anew
constexpr int max_parts = 64;            // of a step

/// Largest change of x by `update`, each kind of unknown measured by its own largest value (or that it would
/// have in a flow driven by the holder at this frequency).
class RelativeChange {
public:
  explicit RelativeChange(const ThinGapStep& step) {
    const auto& point = step.scene->operating_point;
    const double speed =
        2 * std::numbers::pi * point.frequency * std::max(point.stroke * point.stroke_scale, least_stroke);
    const double flow = speed * step.layout->holder_area;
    const double rotation = speed / step.layout->radius.back();
    floors_ = {flow,     flow, step.law.density * speed * speed, step.law.density * speed * speed, speed,
               rotation, speed};
  }
  double operator()(const Eigen::VectorXd& x, const Eigen::VectorXd& update) const {
    double worst = 0;
    const int per_node = ThinGapUnknowns::per_node;
    for (int kind = 0; kind < per_node; ++kind) {
      double size = floors_[kind], change = 0;
      for (int place = 1 + kind; place < x.size(); place += per_node) {
        size = std::max(size, std::abs(x[place]));
        change = std::max(change, std::abs(update[place]));
      }
      worst = std::max(worst, change / size);
    }
    return worst;
  }

private:
  static constexpr double least_stroke = 1e-3; // cm; only a scale, for pumps at rest
  std::array<double, ThinGapUnknowns::per_node> floors_{};
};

/// Right side of the equations for a unit of the holder's velocity.
Eigen::VectorXd unit_holder_motion(const ThinGapStep& step) {
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(step.at.size());
  for (int node = step.layout->clamp; node < step.at.nodes; ++node) motion[step.at.deflection_rate(node)] = 1;
  return motion;
}

/// Newton's iteration from x. Empty, with the reason, where it does not converge. A cycle between the two
/// sides of a closing gap is broken by shorter updates.
std::optional<Eigen::VectorXd> newton(const ThinGapStep& step, Eigen::VectorXd x, BandMatrix& matrix,
                                      PhaseTimer& timer, HolderEquation& holder, std::string& reason) {
  const RelativeChange relative_change(step);
  const bool free = holder_is_free(step);
  Eigen::VectorXd residual, update, by_holder; // by_holder: how all unknowns follow the holder's velocity
  bool fresh = true;                           // the matrix is that of x
  double previous_change = 0;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    {
      const auto scope = timer.measure("assemble");
      assemble(step, x, residual, fresh ? &matrix : nullptr, holder);
    }
    if (fresh) {
      const auto scope = timer.measure("factor");
      if (!matrix.factor()) {
        reason = "the equations are singular";
        return std::nullopt;
      }
      if (free) {
        by_holder = unit_holder_motion(step);
        matrix.solve(by_holder);
      }
    }
    {
      const auto scope = timer.measure("solve");
      update = residual;
      matrix.solve(update);
      // The holder's row reaches over more unknowns than the band: it is eliminated.
      if (free)
        update += (holder.residual - holder.row.dot(update)) /
                  (holder.by_velocity + holder.row.dot(by_holder)) * by_holder;
    }
    if (!update.allFinite()) {
      reason = "the equations have no finite solution";
      return std::nullopt;
    }
    x -= (iteration < full_iterations ? 1.0 : shortening) * update;
    const double change = relative_change(x, update);
    if (change < step.scene->thin_gap.newton_tolerance) {
      const auto scope = timer.measure("assemble");
      assemble(step, x, residual, nullptr, holder);
      return x;
    }
    // An old matrix serves as long as it brings x closer at this rate.
    fresh = iteration > 0 && change > slow_convergence * previous_change;
    previous_change = change;
  }
  reason = "Newton's iteration does not converge in " + std::to_string(max_iterations) + " iterations";
  return std::nullopt;
}

/// What a step ends in.
struct StepResult {
  ThinGapStep step; ///< the last one solved: the whole, or the last part of it
  Eigen::VectorXd x, d;
  HolderEquation holder;
};

/// One time step; where Newton fails, 2, 4, ... steps of backward Euler in its place.
StepResult solve_step(const ThinGapLayout& layout, const Scene& scene, const State& state, BandMatrix& matrix,
                      PhaseTimer& timer) {
  StepResult result{next_step(layout, scene, state), {}, {}, {}};
  std::string reason;
  const Eigen::VectorXd ahead = state.step == 0 ? state.x[0] : Eigen::VectorXd(2 * state.x[0] - state.x[1]);
  if (auto x = newton(result.step, ahead, matrix, timer, result.holder, reason)) {
    result.d = displacements(result.step, *x);
    result.x = std::move(*x);
    return result;
  }
  const double dt = result.step.dt, begin = state.step * dt;
  for (int parts = 2; parts <= max_parts; parts *= 2) {
    State part = state;
    bool solved = true;
    for (int k = 1; k <= parts && solved; ++k) {
      result.step = euler_step(layout, scene, part, dt / parts, begin + k * dt / parts);
      auto x = newton(result.step, part.x[0], matrix, timer, result.holder, reason);
      solved = x.has_value();
      if (solved) {
        part.d[0] = displacements(result.step, *x);
        part.x[0] = std::move(*x);
      }
    }
    if (!solved) continue;
    spdlog::debug("thin-gap step {} taken in {} parts: {}", state.step + 1, parts, reason);
    result.x = std::move(part.x[0]);
    result.d = std::move(part.d[0]);
    return result;
  }
  throw NumericsError(
      "a thin-gap step has no solution: " + reason,
      "step " + std::to_string(state.step + 1) + ", time " + std::to_string(begin + dt) + " s, also in " +
          std::to_string(max_parts) + " parts",
      "more time.steps_per_period, another thin_gap.contact_stiffness_dyn_per_cm3, or a thicker "
      "thin_gap.film_thickness_mm");
}

Observation observe(const ThinGapLayout& layout, const Scene& scene, const ThinGapStep& step,
                    const State& state, double holder_force) {
  const auto& at = step.at;
  const auto& x = state.x[0];
  const auto& d = state.d[0];
  Observation seen;
  seen.step = state.step;
  seen.time = state.time;
  seen.outflow = -(x[at.upper_flow(0)] + x[at.lower_flow(0)]);
  seen.inflow = -(x[at.upper_flow(at.nodes)] + x[at.lower_flow(at.nodes)]);
  seen.hydraulic_power = scene.operating_point.head * seen.outflow;
  seen.energy = thin_gap_energy(step, x, holder_force);
  const auto u = face_velocities(layout, step.law, x, d);
  seen.speed_max = std::max(u.upper.lpNorm<Eigen::Infinity>(), u.lower.lpNorm<Eigen::Infinity>());
  seen.clearance_min = std::numeric_limits<double>::infinity();
  double area = 0;
  const auto add_wall = [&](int node, double height, double velocity) {
    seen.clearance_min = std::min(seen.clearance_min, height);
    const double open = open_height(step.law, height);
    const double shear = 0.5 * open * gap_friction(step.law, open) * std::abs(velocity);
    seen.wall_shear_max = std::max(seen.wall_shear_max, shear);
    seen.wall_shear_mean += node_area(layout, node) * shear;
    area += node_area(layout, node);
  };
  for (int node = 0; node < at.nodes; ++node) {
    const double w = d[at.deflection(node)];
    if (node < layout.channel)
      add_wall(node, upper_height(layout, node, w), 0.5 * (u.upper[node] + u.upper[node + 1]));
    if (node >= layout.lip)
      add_wall(node, lower_height(layout, node, w), 0.5 * (u.lower[node] + u.lower[node + 1]));
  }
  seen.wall_shear_mean /= area;
  seen.tip_displacement = d[at.deflection(0)];
  const bool driven = scene.operating_point.drive == Drive::voltage;
  seen.holder = observe_holder(driven ? &scene.actuator : nullptr, step.voltage,
                               d[at.deflection(at.nodes - 1)], holder_velocity(step, x), holder_force);
  return seen;
}

} // namespace

ThinGapModel prepare_thin_gap(const Scene& scene, PhaseTimer& timer) {
  const PumpProfile profile = scene_profile(scene);
  check_pump_work(scene, profile);
  SimplexMesh<2> background;
  {
    const auto scope = timer.measure("mesh");
    background = pump_background(profile, {scene.mesh.gap_elements, scene.mesh.channel_size,
                                           scene.mesh.membrane_size, scene.mesh.growth});
  }
  const auto scope = timer.measure("coefficients");
  const double clamp = scene.clamp_radius > 0 ? scene.clamp_radius : profile.membrane.clamp_radius;
  return {thin_gap_layout(profile, background, clamp, scene.thin_gap.cells)};
}

int unknowns(const ThinGapModel& model) {
  return ThinGapUnknowns{static_cast<int>(model.layout.radius.size())}.size();
}

State initial_state(const ThinGapModel& model) {
  const ThinGapUnknowns at{static_cast<int>(model.layout.radius.size())};
  State state;
  for (auto& x : state.x) x.setZero(at.size());
  for (auto& d : state.d) d.setZero(at.displacements());
  return state;
}

ThinGapStepper::ThinGapStepper(const ThinGapModel& model, const Scene& scene, PhaseTimer& timer)
    : model_(model), scene_(scene), timer_(timer), matrix_(unknowns(model), ThinGapUnknowns::reach) {}

Observation ThinGapStepper::advance(State& state) {
  StepResult result = solve_step(model_.layout, scene_, state, matrix_, timer_);
  state.d[1] = std::exchange(state.d[0], std::move(result.d));
  state.x[1] = std::exchange(state.x[0], std::move(result.x));
  ++state.step;
  state.time = state.step * time_step(scene_);
  const auto scope = timer_.measure("observe");
  return observe(model_.layout, scene_, result.step, state, result.holder.force);
}

MembraneProbes membrane_probes(const ThinGapModel& model, int count) {
  const auto& layout = model.layout;
  const ThinGapUnknowns at{static_cast<int>(layout.radius.size())};
  MembraneProbes probes;
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = 0; k < count; ++k) {
    const double s = static_cast<double>(k) / (count - 1) * (at.nodes - 1);
    const int inner = std::min(static_cast<int>(s), at.nodes - 2);
    probes.radius.push_back((inner + 1 - s) * layout.radius[inner] + (s - inner) * layout.radius[inner + 1]);
    entries.emplace_back(k, at.deflection(inner), inner + 1 - s);
    entries.emplace_back(k, at.deflection(inner + 1), s - inner);
  }
  probes.axial.resize(count, at.displacements());
  probes.axial.setFromTriplets(entries.begin(), entries.end());
  return probes;
}

} // namespace undula::fom
