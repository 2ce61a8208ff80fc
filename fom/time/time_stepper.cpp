#include "fom/time/time_stepper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "fom/time/holder_step.hpp"
#include "fom/time/step_parts.hpp"
#include "rom/base/error.hpp"

namespace undula::fom {

template <int dim>
Point<dim> imposed_displacement(const Discretisation<dim>& disc, const ImposedNode<dim>& node, double t) {
  const auto& field = disc.problem.solids[node.solid].imposed_displacement;
  return field ? field(node.position, t) : Point<dim>::Zero();
}

template <int dim>
State initial_state(const Discretisation<dim>& disc) {
  State state;
  for (auto* levels : {&state.x, &state.d})
    for (auto& level : *levels) level = Eigen::VectorXd::Zero(disc.unknowns());
  for (std::size_t s = 0; s < disc.problem.solids.size(); ++s) {
    const auto& velocity = disc.problem.solids[s].initial_velocity;
    if (!velocity) continue;
    const auto& nodes = disc.solid_spaces[s].nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      state.x[0].template segment<dim>(disc.solid_unknown(static_cast<int>(s), static_cast<int>(i), 0)) =
          velocity(nodes[i], 0.0);
  }
  return state;
}

namespace {

/// Throws NumericsError where skins end deeper in their film than their pair allows.
template <int dim>
void check_depth(const std::vector<ContactPair>& pairs, const std::vector<PairReport<dim>>& reports) {
  for (std::size_t p = 0; p < reports.size(); ++p)
    if (reports[p].penetration > pairs[p].deepest)
      throw NumericsError("skins pass into each other, [pair." + pairs[p].name + "]",
                          std::to_string(reports[p].penetration) + " cm deep in the film, at most " +
                              std::to_string(pairs[p].deepest),
                          "a stiffer pair (stiffness_dyn_per_cm3) or smaller steps");
}

} // namespace

std::array<double, 3> bdf_coefficients(TimeScheme scheme, int step, double ratio) {
  if (scheme == TimeScheme::bdf1 || step <= 1) return {1.0, -1.0, 0.0};
  return {(1 + 2 * ratio) / (1 + ratio), -(1 + ratio), ratio * ratio / (1 + ratio)};
}

template <int dim>
TimeStepper<dim>::TimeStepper(const Discretisation<dim>& disc, const Operators<dim>& operators,
                              TimeScheme scheme, double dt, int factor_every, PhaseTimer& timer,
                              const NewtonSettings& newton, const ConvectionSettings& convection,
                              bool contact)
    : disc_(disc),
      operators_(operators),
      scheme_(scheme),
      dt_(dt),
      timer_(timer),
      newton_(newton),
      convection_(convection),
      system_(disc, operators, factor_every, timer,
              convection.tolerance > 0 || contact || has_skin_forces(disc.problem)) {
  if (has_skin_forces(disc.problem)) skin_ = prepare_skin_forces(disc, dt);
}

template <int dim>
void TimeStepper<dim>::set_contact(const WallContact<dim>& contact, const Eigen::VectorXd& placement) {
  contact_with_ = &contact;
  linearise_contact(placement);
}

template <int dim>
void TimeStepper<dim>::linearise_contact(const Eigen::VectorXd& placement) {
  contact_ = contact_force(*contact_with_, disc_, placement);
  contact_about_ = placement;
  add_to_system();
}

template <int dim>
void TimeStepper<dim>::linearise_skin(const SkinMotion<dim>& motion) {
  if (!skin_) return;
  {
    const auto scope = timer_.measure("assemble");
    skin_here_ = skin_response<dim>(*skin_, disc_, motion, true);
    skin_load_ = skin_here_.loads + skin_here_.contact + skin_here_.stiffness * motion.d;
  }
  add_to_system();
}

template <int dim>
void TimeStepper<dim>::add_to_system() {
  const bool adds = operators_.rank == 0 && (contact_ || skin_load_.size() > 0);
  if (adds && contact_ && skin_load_.size() > 0)
    added_ = contact_->stiffness + skin_here_.stiffness;
  else if (adds)
    added_ = contact_ ? contact_->stiffness : skin_here_.stiffness;
  system_.add_stiffness(adds ? &added_ : nullptr);
}

template <int dim>
std::string TimeStepper<dim>::missed_on_skin(const Eigen::VectorXd& d, const Eigen::VectorXd& v, double t,
                                             double rate) {
  if (!skin_) return {};
  skin_there_ = skin_response<dim>(*skin_, disc_, {d, v, t, rate}, false);
  const auto free = [&](Eigen::VectorXd values) {
    constrain_rows(disc_, values);
    return values;
  };
  const Eigen::VectorXd exact = skin_there_.loads + skin_there_.contact;
  const double left = free(exact - (skin_load_ - skin_here_.stiffness * d)).norm(),
               rounding = 4 * std::numeric_limits<double>::epsilon() *
                          (skin_here_.stiffness.cwiseAbs() * d.cwiseAbs()).norm();
  if (left > newton_.tolerance * exact.norm() + rounding)
    return "contact and loads on the skins are out of balance by " +
           std::to_string(left / std::max(exact.norm(), std::numeric_limits<double>::min())) +
           " of their force";
  return {};
}

template <int dim>
double TimeStepper<dim>::distance_by_energy(const Eigen::VectorXd& x, const Eigen::VectorXd& y) const {
  const int fluid = disc_.fluid_unknowns(), solid = disc_.unknowns() - fluid;
  Eigen::VectorXd flow = x, difference = x - y;
  flow.tail(solid).setZero();
  difference.tail(solid).setZero();
  Eigen::VectorXd sums(2);
  sums << difference.dot(operators_.mass * difference), flow.dot(operators_.mass * flow);
  sum_over_ranks(operators_.comm, sums);
  return sums[0] > 0 ? std::sqrt(sums[0] / std::max(sums[1], std::numeric_limits<double>::min())) : 0.0;
}

template <int dim>
std::string TimeStepper<dim>::missed(const Eigen::VectorXd& x, const Eigen::VectorXd& d, double t,
                                     double rate) {
  std::string what;
  if (skin_) {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(disc_.unknowns());
    all.tail(d.size()) = d;
    what = missed_on_skin(all, x, t, rate);
  }
  if (contact_with_) {
    constexpr double accuracy = 0.02; // of the film's force
    auto balance = contact_balance(*contact_with_, contact_about_, d);
    contact_nodes_ = std::max(contact_nodes_, contact_->nodes);
    contact_next_ = std::move(balance.linearised);
    if (balance.smallest_gap <= 0)
      what = "a solid would pass a wall, by " + std::to_string(-balance.smallest_gap) + " cm";
    else if (balance.error > accuracy)
      what = "the film of contact is out of balance by " + std::to_string(balance.error) +
             " of its force; a stiffer or thicker film (section [contact]) helps";
  }
  if (disc_.problem.flow != FlowModel::navier_stokes) return what;
  const double error = distance_by_energy(x, convecting_);
  if (iterations_ == 1) convection_error_ = error;
  if (what.empty() && convection_.tolerance > 0 && error > convection_.tolerance)
    what = "the convecting velocity is off by " + std::to_string(error) + " (time.convection_tolerance)";
  return what;
}

template <int dim>
Eigen::VectorXd TimeStepper<dim>::loads(double t) const {
  Eigen::VectorXd load = loads_at(disc_, operators_, t);
  if (contact_) load += contact_->load;
  return load;
}

template <int dim>
void TimeStepper<dim>::impose(const State& state, std::array<double, 3> alpha, double t,
                              Eigen::VectorXd& rhs) const {
  for (const auto& constrained : disc_.constrained)
    rhs[constrained.unknown] = imposed_fluid_value(constrained, t);
  const bool driven = disc_.problem.holder.has_value();
  for (const auto& node : disc_.imposed) {
    const Point<dim> target = driven ? Point<dim>::Zero() : imposed_displacement(disc_, node, t);
    for (int c = 0; c < dim - driven; ++c) {
      const int u = node.unknown + c;
      // The scheme's derivative of the exact displacement, so that the displacement itself is met exactly.
      rhs[u] = (alpha[0] * target[c] + alpha[1] * state.d[0][u] + alpha[2] * state.d[1][u]) / dt_;
    }
  }
}

template <int dim>
template <class Solve>
Eigen::VectorXd TimeStepper<dim>::solve_with_holder(const State& state, const std::array<double, 3>& alpha,
                                                    double t, Eigen::VectorXd& rhs, Solve&& solve) const {
  const auto& holder = *disc_.problem.holder;
  const int unknown = disc_.joined.front();
  const double others = rhs[unknown];
  auto step = holder_step(holder, alpha, dt_, t, state, unknown, convecting_[unknown]);
  // Stops make the equation a broken line: one more turn for every piece that the answer is not on.
  constexpr int most = 8;
  for (int turn = 0; turn < most; ++turn) {
    rhs[unknown] = others + step.force;
    SystemFactors factors;
    factors.holder = step.by_velocity;
    Eigen::VectorXd x = solve(factors, rhs);
    const double v = x[unknown];
    const auto there = holder_step(holder, alpha, dt_, t, state, unknown, v);
    const double left = (there.by_velocity - step.by_velocity) * v - (there.force - step.force);
    if (std::abs(left) <= 1e-10 * std::max(std::abs(step.force), std::abs(step.by_velocity * v))) return x;
    step = there;
  }
  throw NumericsError("the holder does not settle at its stops", std::to_string(most) + " turns",
                      "softer stops or a smaller time step");
}

template <int dim>
void TimeStepper<dim>::advance(State& state) {
  advance_to((state.step + 1) * dt_, state);
}

template <int dim>
void TimeStepper<dim>::advance_to(double t, State& state) {
  const int step = state.step + 1;
  const double ratio = state.last_step > 0 ? dt_ / state.last_step : 1.0;
  const auto alpha = bdf_coefficients(scheme_, step, ratio);
  const Eigen::VectorXd history_d = alpha[1] * state.d[0] + alpha[2] * state.d[1];
  Eigen::VectorXd rhs;
  {
    const auto scope = timer_.measure("assemble");
    rhs = operators_.stiffness * (history_d / alpha[0]) -
          operators_.mass * ((alpha[1] * state.x[0] + alpha[2] * state.x[1]) / dt_);
    sum_over_ranks(operators_.comm, rhs);
    rhs += loads_at(disc_, operators_, t);
    constrain_rows(disc_, rhs);
    impose(state, alpha, t, rhs);
    convecting_ = scheme_ == TimeScheme::bdf2 && step > 1
                      ? Eigen::VectorXd((1 + ratio) * state.x[0] - ratio * state.x[1])
                      : state.x[0];
  }
  iterations_ = contact_nodes_ = 0;
  const int fluid = disc_.fluid_unknowns(), solid = disc_.unknowns() - fluid;
  const auto displaced = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return (dt_ * x.tail(solid) - history_d.tail(solid)) / alpha[0];
  };
  const Eigen::VectorXd expected = convecting_;
  const double rate = alpha[0] / dt_;
  const auto linearise_skin_about = [&](const Eigen::VectorXd& x, const Eigen::VectorXd* before) {
    if (!skin_) return;
    Eigen::VectorXd d = Eigen::VectorXd::Zero(disc_.unknowns());
    d.tail(solid) = displaced(x);
    linearise_skin({d, x, t, rate, before, state.time});
  };
  const auto solve = [&](SystemFactors factors, const Eigen::VectorXd& right) {
    factors.mass = alpha[0] / dt_;
    factors.stiffness = dt_ / alpha[0];
    Eigen::VectorXd side;
    const auto assemble = [&] {
      system_.assemble(factors, &convecting_);
      side = right;
      const auto add_force = [&](const SparseMatrix& stiffness, const Eigen::VectorXd& load) {
        Eigen::VectorXd force = load + stiffness * (history_d / alpha[0]);
        constrain_rows(disc_, force);
        side += force;
      };
      if (contact_) add_force(contact_->stiffness, contact_->load);
      if (skin_) add_force(skin_here_.stiffness, skin_load_);
    };
    OtherTerms others;
    others.renew = [&](const Eigen::VectorXd& x) {
      if (contact_with_) linearise_contact(contact_next_);
      if (convection_.tolerance > 0) convecting_ = x;
      linearise_skin_about(x, nullptr);
      if (contact_with_ || skin_ || convection_.tolerance > 0) assemble();
    };
    others.missed = [&](const Eigen::VectorXd& x) {
      ++iterations_;
      return missed(x, displaced(x), t, rate);
    };
    linearise_skin_about(expected, &state.d[0]);
    assemble();
    Eigen::VectorXd x = expected;
    solve_newton<dim>(system_, disc_, operators_, {{dt_ / alpha[0], 1.0}, -history_d / alpha[0], state.d[0]},
                      side, newton_, step, !skin_, x, others);
    return x;
  };
  Eigen::VectorXd x;
  try {
    x = disc_.problem.holder ? solve_with_holder(state, alpha, t, rhs, solve) : solve({}, rhs);
    check_depth(disc_.problem.pairs, skin_there_.reports);
  } catch (const NumericsError& error) {
    throw NumericsError(std::string("time step failed: ") + error.what(),
                        "step " + std::to_string(step) + ", t = " + std::to_string(t) + " s",
                        "restart from the last checkpoint with a smaller step");
  }
  older_x_ = std::move(state.x[1]);
  older_d_ = std::move(state.d[1]);
  state.x[1] = std::move(state.x[0]);
  state.d[1] = std::move(state.d[0]);
  state.d[0] = Eigen::VectorXd::Zero(disc_.unknowns());
  state.d[0].tail(solid) = displaced(x);
  state.x[0] = std::move(x);
  state.step = step;
  state.time = t;
  alpha_ = alpha;
}

template Point<2> imposed_displacement(const Discretisation<2>&, const ImposedNode<2>&, double);
template State initial_state(const Discretisation<2>&);
template class TimeStepper<2>;

template Point<3> imposed_displacement(const Discretisation<3>&, const ImposedNode<3>&, double);
template State initial_state(const Discretisation<3>&);
template class TimeStepper<3>;

} // namespace undula::fom
