#include "fom/coupling/moving_stepper.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "fom/assembly/part_geometry.hpp"
#include "rom/base/error.hpp"

namespace undula::fom {

template <int dim>
MovingStepper<dim>::MovingStepper(Discretisation<dim>& disc, Operators<dim>& operators, Coupling coupling,
                                  const SteppingSettings& settings, const ContactSettings& contact, double dt,
                                  PhaseTimer& timer, const State& state)
    : disc_(disc), operators_(operators), coupling_(coupling), settings_(settings), dt_(dt), timer_(timer) {
  // Contact and extension are prepared at rest: a march before may have left the domain moved.
  disc_.map = {};
  if (contact.film > 0) contact_ = prepare_contact(disc_, contact);
  if (coupling_ == Coupling::mapped) {
    const auto scope = timer_.measure("map");
    extension_ = prepare_extension(disc_);
    unfolding_ = prepare_unfolding(disc_);
  }
  restore(state);
  if (state.x[0].size() != disc_.unknowns())
    throw InputError("the state does not fit the cut at its placement",
                     std::to_string(state.x[0].size()) + " values",
                     std::to_string(disc_.unknowns()) + " unknowns", "State::x");
}

template <int dim>
void MovingStepper<dim>::restore(const State& state) {
  if (coupling_ == Coupling::mapped) {
    disc_.map = {by_node<dim>(state.map[0]), {}};
    disc_.map.velocity.assign(disc_.map.displacement.size(), Point<dim>::Zero());
  } else {
    const auto scope = timer_.measure("cut");
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(disc_.solid_unknowns());
    disc_ = recut(disc_, state.placement.size() > 0 ? state.placement : rest, cut_options_);
  }
  operators_ = build_operators(disc_, operators_.comm, timer_);
}

template <int dim>
Eigen::VectorXd MovingStepper<dim>::extrapolated_placement(const State& state, double t, double dt) const {
  const Eigen::Index solids = disc_.solid_unknowns();
  const double ratio = state.last_step > 0 ? dt / state.last_step : 1.0;
  const auto displacement = state.d[0].tail(solids), velocity = state.x[0].tail(solids);
  Eigen::VectorXd placement = displacement + dt * velocity;
  // The velocity half-way through the step, by what it was before.
  if (settings_.motion.extrapolation == Extrapolation::second && state.step > 0)
    placement += 0.5 * dt * ratio * (velocity - state.x[1].tail(solids));
  if (disc_.problem.holder) return placement;
  for (const auto& node : disc_.imposed)
    placement.template segment<dim>(node.unknown - disc_.fluid_unknowns()) =
        imposed_displacement(disc_, node, t);
  return placement;
}

template <int dim>
void MovingStepper<dim>::solve_placed(const Eigen::VectorXd& placement, double t, double dt, State& state) {
  if (coupling_ == Coupling::mapped)
    move_operators(disc_, operators_, timer_);
  else
    operators_ = build_operators(disc_, operators_.comm, timer_);
  // A map leaves the pattern as it is: only the numbers are new.
  if (coupling_ == Coupling::mapped && stepper_ && stepper_->dt() == dt)
    stepper_->system().refresh();
  else
    stepper_.emplace(disc_, operators_, settings_.scheme, dt, 1, timer_, settings_.newton,
                     settings_.convection, contact_.has_value());
  if (contact_) stepper_->set_contact(*contact_, placement);
  stepper_->advance_to(t, state);
  report_.contact_nodes = std::max(report_.contact_nodes, stepper_->contact_nodes());
  report_.solves += stepper_->iterations();
}

template <int dim>
void MovingStepper<dim>::place_cut(const Eigen::VectorXd& placement, const State& before,
                                   Discretisation<dim>& origin, State& state) {
  const auto scope = timer_.measure("cut");
  auto next = recut(disc_, placement, cut_options_);
  if (origin.cut.parts.empty()) origin = std::move(disc_);
  disc_ = std::move(next);
  const FieldTransfer<dim> transfer(origin, disc_);
  state.step = before.step;
  state.time = before.time;
  for (int level : {0, 1}) {
    state.x[level] = transfer.unknowns(before.x[level]);
    state.d[level] = transfer.displacements(before.d[level]);
  }
  report_.new_nodes = std::max(report_.new_nodes, transfer.extended());
}

template <int dim>
std::vector<Point<dim>> MovingStepper<dim>::unfolded(const std::vector<Point<dim>>& target,
                                                     const Eigen::VectorXd& last, const State& before) {
  const auto starts = [&] {
    std::vector<Eigen::VectorXd> places;
    if (before.placement.size() > 0) // with the correction of the step before
      places.push_back(in_a_row<dim>(target) + last - in_a_row<dim>(extend(*extension_, before.placement)));
    places.push_back(last);
    return places;
  };
  auto map = unfold<dim>(*unfolding_, target, starts);
  report_.unfolding_iterations = std::max(report_.unfolding_iterations, map.iterations);
  return std::move(map.displacement);
}

template <int dim>
void MovingStepper<dim>::place_map(const Eigen::VectorXd& placement, double dt, const State& before,
                                   State& state) {
  const auto scope = timer_.measure("map");
  state = before;
  const double ratio = before.last_step > 0 ? dt / before.last_step : 1.0;
  const auto alpha = bdf_coefficients(settings_.scheme, before.step + 1, ratio);
  auto& map = disc_.map;
  const auto length = static_cast<Eigen::Index>(disc_.fluid_nodes.dof_point.size()) * dim;
  const auto level_before = [&](int level) -> Eigen::VectorXd {
    return before.map[level].size() > 0 ? before.map[level] : Eigen::VectorXd::Zero(length);
  };
  const Eigen::VectorXd last = level_before(0), older = level_before(1);
  map.displacement = unfolded(extend(*extension_, placement), last, before);
  state.map[1] = last;
  state.map[0] = in_a_row<dim>(map.displacement);
  map.velocity = by_node<dim>((alpha[0] * state.map[0] + alpha[1] * last + alpha[2] * older) / dt);
  const auto smallest = smallest_volume(disc_);
  report_.smallest_volume_ratio = std::min(report_.smallest_volume_ratio, smallest.ratio);
  std::string place;
  for (int c = 0; c < dim; ++c) place += (c > 0 ? ", " : "") + std::to_string(smallest.place[c]);
  if (smallest.ratio <= 0)
    throw NumericsError(
        "the map of the fluid's domain folds",
        "volume ratio " + std::to_string(smallest.ratio) + " of the element at rest about (" + place + ") cm",
        "coupling = \"explicit\", which cuts anew, or a smaller time step");
}

template <int dim>
bool MovingStepper<dim>::settled(const Eigen::VectorXd& placed, const Eigen::VectorXd& computed) const {
  constexpr double film = 0.2; // a flow through a film feels its height
  switch (coupling_) {
    case Coupling::implicit:
      return (computed - placed).template lpNorm<Eigen::Infinity>() <= settings_.motion.tolerance;
    case Coupling::mapped:
      return !contact_ || film_difference(*contact_, placed, computed) <= film;
    default:
      return true;
  }
}

template <int dim>
void MovingStepper<dim>::advance_part(double t, double dt, State& state) {
  const State before = state;
  const auto solids = disc_.solid_unknowns();
  Discretisation<dim> origin; // cut and numbering of `before`
  Eigen::VectorXd placement = extrapolated_placement(state, t, dt);
  if (contact_) keep_off_walls<dim>(*contact_, before.d[0].tail(solids), placement);
  const bool repeats = coupling_ == Coupling::implicit || (coupling_ == Coupling::mapped && contact_);
  const int turns = repeats ? settings_.motion.max_iterations : 1;
  double error = 0;
  for (int turn = 1; turn <= turns; ++turn) {
    if (coupling_ == Coupling::mapped)
      place_map(placement, dt, before, state);
    else
      place_cut(placement, before, origin, state);
    solve_placed(placement, t, dt, state);
    state.last_step = dt;
    state.placement = placement;
    error = (state.d[0].tail(solids) - placement).template lpNorm<Eigen::Infinity>();
    report_.iterations = std::max(report_.iterations, turn);
    if (settled(placement, state.d[0].tail(solids))) {
      if (contact_)
        report_.film_change =
            std::max(report_.film_change,
                     film_difference<dim>(*contact_, before.d[0].tail(solids), state.d[0].tail(solids)));
      report_.placement_error = std::max(report_.placement_error, error);
      return;
    }
    placement = state.d[0].tail(solids);
  }
  throw NumericsError(
      "placing the solids and solving do not settle",
      "t = " + std::to_string(t) + " s, the solids end " + std::to_string(error) +
          " cm from where they were placed after " + std::to_string(turns) + " turns",
      std::string("a smaller time step, more turns (time.coupling_iterations)") +
          (coupling_ == Coupling::implicit ? " or a larger tolerance (time.coupling_tolerance_mm)"
                                           : ", or a thicker film (contact.film_mm)"));
}

template <int dim>
void MovingStepper<dim>::advance(State& state) {
  const State before = state;
  const double end = (before.step + 1) * dt_;
  // After parts, the step is tried in half as many.
  int parts = before.last_step > 0 ? static_cast<int>(std::lround(dt_ / before.last_step)) : 1;
  parts = std::max(1, parts / 2);
  constexpr int most_for_films = 8;
  const auto too_violent = [&] {
    return settings_.motion.film_change > 0 && report_.film_change > settings_.motion.film_change &&
           2 * parts <= most_for_films;
  };
  while (true) {
    report_ = {};
    report_.parts = parts;
    try {
      for (int part = 1; part <= parts && !too_violent(); ++part)
        advance_part(part == parts ? end : before.time + dt_ * part / parts, dt_ / parts, state);
      if (too_violent()) {
        state = before;
        restore(state);
        parts *= 2;
        continue;
      }
      state.step = before.step + 1;
      return;
    } catch (const NumericsError& error) {
      state = before;
      restore(state);
      parts *= 2;
      if (parts > (1 << settings_.motion.max_halvings))
        throw NumericsError(
            std::string("the time step was halved as often as allowed: ") + error.what(),
            "step " + std::to_string(before.step + 1) + ", t = " + std::to_string(end) + " s",
            "restart from the last checkpoint with a smaller step, or more halvings (time.halvings)");
      if (operators_.rank == 0) spdlog::warn("step {} in {} parts: {}", before.step + 1, parts, error.what());
    }
  }
}

template class MovingStepper<2>;

template class MovingStepper<3>;

} // namespace undula::fom
