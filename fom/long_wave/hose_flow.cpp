#include "fom/long_wave/hose_flow.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fom/long_wave/hose_friction.hpp"
#include "fom/long_wave/hose_pressures.hpp"
#include "fom/scene/scene_time.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"

namespace undula::fom {
namespace {

using std::numbers::pi;

/// Adds a piece of hose of one bore and flow.
void add_piece(const HoseModel& model, double flow, double length, double area, double gradient,
               HoseFlow& sum, double& friction) {
  const double velocity = flow / area;
  sum.momentum += model.fluid.density * velocity * length;
  sum.kinetic += 0.5 * model.fluid.density * flow * velocity * length;
  sum.dissipation += flow * gradient * length;
  sum.speed_max = std::max(sum.speed_max, std::abs(velocity));
  // Balance of a piece of fluid: the outline is 2 pi a long.
  const double shear = std::abs(gradient) * area / (2 * pi * model.track.bore_radius);
  sum.shear_max = std::max(sum.shear_max, shear);
  sum.shear_mean += shear * length / model.length;
  friction += gradient * length;
}

} // namespace

double friction_gradient(const FluidProperties& fluid, double flow, double area, double conductance,
                         double diameter) {
  const double reynolds = fluid.density * std::abs(flow) * diameter / (area * fluid.viscosity);
  return fluid.viscosity * flow / conductance * turbulent_factor(reynolds);
}

double open_friction_gradient(const HoseModel& model, double flow) {
  const double a = model.track.bore_radius;
  return friction_gradient(model.fluid, flow, model.area, flattened_conductance(a, 2 * a), 2 * a);
}

double outlet_static_pressure(const HoseModel& model, double head, double outflow) {
  const double u = outflow / model.area;
  return outflow > 0 ? head : head - (1 + model.hose.entry_loss) * 0.5 * model.fluid.density * u * u;
}

HoseInstant hose_at(const HoseModel& model, double frequency, double time) {
  HoseInstant instant{time, {}};
  for (const PressedPlace& place : pressed_places(model, frequency, time))
    instant.places.push_back(squeezed_place(model, place));
  return instant;
}

HoseFlow hose_flow(const HoseModel& model, const HoseInstant& instant, double head, double outflow) {
  const double density = model.fluid.density;
  HoseFlow sum;
  sum.outflow = outflow;
  double friction = 0, losses = 0, narrowest = 2 * model.track.bore_radius;

  // From the outlet to the inlet.
  double flow = outflow, right_end = model.length;
  const auto add_open = [&](double left_end) {
    add_piece(model, flow, right_end - left_end, model.area, open_friction_gradient(model, flow), sum,
              friction);
  };
  for (auto place = instant.places.rbegin(); place != instant.places.rend(); ++place) {
    add_open(place->at.position + place->reach);
    for (const PlaceSample& sample : place->samples) {
      const double here = flow + sample.added;
      add_piece(model, here, sample.length, sample.area,
                friction_gradient(model.fluid, here, sample.area, sample.conductance, sample.diameter), sum,
                friction);
    }
    const double relative = flow + place->throat_added - place->at.speed * place->throat_area;
    const double throat = relative / place->throat_area, open = relative / model.area;
    const double loss = (1 - model.hose.throat_recovery) * 0.5 * density * (throat * throat - open * open) *
                        (relative < 0 ? -1 : 1);
    losses += loss;
    sum.dissipation += loss * relative;
    if (place->at.gap < narrowest) {
      narrowest = place->at.gap;
      sum.leak = -relative;
    }
    flow += place->left_added;
    right_end = place->at.position - place->reach;
  }
  add_open(0);
  sum.inflow = flow;

  // The ends. The inlet's reservoir is at zero pressure.
  const double out = outflow / model.area, in = flow / model.area, entry = model.hose.entry_loss;
  const double out_kinetic = 0.5 * density * out * out, in_kinetic = 0.5 * density * in * in;
  const double inlet_pressure = flow > 0 ? -(1 + entry) * in_kinetic : 0;
  sum.drive = inlet_pressure - outlet_static_pressure(model, head, outflow) - (out_kinetic - in_kinetic) -
              friction - losses;
  sum.opening = -head * outflow;
  (outflow > 0 ? sum.carried : sum.dissipation) +=
      std::abs(outflow) * (outflow > 0 ? 1 : entry) * out_kinetic;
  (flow < 0 ? sum.carried : sum.dissipation) += std::abs(flow) * (flow < 0 ? 1 : entry) * in_kinetic;
  return sum;
}

double elastic_energy(const HoseModel& model, const HoseInstant& instant) {
  double energy = 0;
  if (!model.ring) return energy;
  for (const SqueezedPlace& place : instant.places)
    for (const PlaceSample& sample : place.samples)
      energy += sample.length * (*model.ring)(sample.height + model.hose.wall).energy;
  return energy;
}

State hose_state_at_rest(const HoseModel& model) {
  State state;
  for (auto& x : state.x) x = Eigen::VectorXd::Zero(1);
  for (auto& d : state.d) d = Eigen::VectorXd::Zero(model.track.rollers);
  return state;
}

HoseStepper::HoseStepper(const HoseModel& model, const Scene& scene, PhaseTimer& timer)
    : model_(model),
      timer_(timer),
      frequency_(scene.operating_point.frequency),
      head_(scene.operating_point.head),
      step_(time_step(scene)) {}

/// Outflow with momentum - weight * drive = right_side. The left side grows with the outflow.
double HoseStepper::solve_stage(const HoseInstant& instant, double weight, double right_side,
                                double guess) const {
  const double scale = model_.area * 2 * pi * frequency_ * geometry::centreline_radius(model_.track);
  const auto excess = [&](double outflow) {
    const HoseFlow flow = hose_flow(model_, instant, head_, outflow);
    return flow.momentum - weight * flow.drive - right_side;
  };
  // 1. A bracket.
  double low = guess, high = guess, width = 0.01 * scale;
  double below = excess(low), above = below;
  constexpr int widenings = 200, iterations = 100;
  for (int i = 0; i < widenings && below > 0; ++i, width *= 2) {
    high = low, above = below;
    low -= width;
    below = excess(low);
  }
  for (int i = 0; i < widenings && above < 0; ++i, width *= 2) {
    low = high, below = above;
    high += width;
    above = excess(high);
  }
  // 2. Regula falsi, halved where an end stays (Illinois).
  if (below <= 0 && above >= 0)
    for (int i = 0, side = 0; i < iterations; ++i) {
      if (below == 0) return low;
      if (above == 0) return high;
      const double middle = (low * above - high * below) / (above - below), value = excess(middle);
      const bool is_low = value < 0;
      const double moved = std::abs(middle - (is_low ? low : high));
      (is_low ? low : high) = middle;
      (is_low ? below : above) = value;
      if (std::min(moved, high - low) <= 1e-11 * scale || value == 0) return middle;
      if (side == (is_low ? -1 : 1)) (is_low ? above : below) *= 0.5;
      side = is_low ? -1 : 1;
    }
  throw NumericsError("no outflow of the hose balances its momentum",
                      "between " + plain_number(low) + " and " + plain_number(high) + " cm^3/s",
                      "t = " + plain_number(instant.time) + " s; shorter steps may help");
}

Observation HoseStepper::advance(State& state) const {
  static const double gamma = 1 - 1 / std::numbers::sqrt2;
  State next = state;
  HoseInstant end;
  {
    const auto scope = timer_.measure("solve");
    const double begin_momentum =
        hose_flow(model_, hose_at(model_, frequency_, state.time), head_, state.x[0][0]).momentum;
    const HoseInstant inner = hose_at(model_, frequency_, state.time + gamma * step_);
    const double inner_outflow = solve_stage(inner, gamma * step_, begin_momentum, state.x[0][0]);
    const double inner_drive = hose_flow(model_, inner, head_, inner_outflow).drive;
    // Counted from the first step, so that a march that goes on repeats bit for bit.
    next.step = state.step + 1;
    next.time = next.step * step_;
    end = hose_at(model_, frequency_, next.time);
    next.x[1] = state.x[0];
    next.x[0][0] =
        solve_stage(end, gamma * step_, begin_momentum + (1 - gamma) * step_ * inner_drive, inner_outflow);
  }
  const auto scope = timer_.measure("observe");
  next.d[1] = state.d[0];
  next.d[0].setZero();
  for (const SqueezedPlace& place : end.places)
    next.d[0][place.at.roller] =
        std::max(next.d[0][place.at.roller], 2 * model_.track.bore_radius - place.at.gap);
  const Observation seen = observe(state, next, end);
  state = next;
  return seen;
}

Observation HoseStepper::observe(const State& before, const State& after, const HoseInstant& instant) const {
  const HoseInstant start = hose_at(model_, frequency_, before.time);
  const HoseFlow then = hose_flow(model_, start, head_, before.x[0][0]),
                 now = hose_flow(model_, instant, head_, after.x[0][0]);
  const double elastic = elastic_energy(model_, instant);
  const double growth = (now.kinetic - then.kinetic + elastic - elastic_energy(model_, start)) / step_;

  Observation seen;
  seen.step = after.step;
  seen.time = after.time;
  seen.outflow = now.outflow;
  seen.inflow = now.inflow;
  seen.hydraulic_power = head_ * now.outflow;
  seen.energy.opening = now.opening;
  seen.energy.viscous = now.dissipation;
  seen.energy.carried = now.carried;
  seen.energy.kinetic = now.kinetic;
  seen.energy.elastic = elastic;
  // Rollers without friction: their power is what the fluid and the hose take.
  seen.energy.holder = now.dissipation + now.carried - now.opening + growth;
  seen.speed_max = now.speed_max;
  seen.wall_shear_max = now.shear_max;
  seen.wall_shear_mean = now.shear_mean;
  seen.clearance_min = 2 * model_.track.bore_radius - after.d[0].maxCoeff();
  const HosePressures pressures =
      hose_pressures(model_, instant, head_, now.outflow, (now.outflow - then.outflow) / step_);
  HoseObservation hose;
  hose.angle = roller_angle(model_, frequency_, after.time, 0);
  hose.torque = seen.energy.holder / (2 * pi * frequency_);
  hose.leak = now.leak;
  hose.outlet_pressure = pressures.at(last_pressed(model_));
  if (model_.ring) hose.roller_force = largest_roller_force(model_, instant, pressures);
  seen.hose = hose;
  return seen;
}

} // namespace undula::fom
