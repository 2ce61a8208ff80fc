#include "fom/time/time_stepper.hpp"

#include <string>
#include <utility>

#include "rom/base/error.hpp"

namespace undula::fom {

namespace {

/// Loads that do not depend on the state: openings and body forces, complete on every rank.
template <int dim>
Eigen::VectorXd loads_at(const Discretisation<dim>& disc, const Operators<dim>& operators, double t) {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(disc.unknowns());
  bool has_body_force = static_cast<bool>(disc.problem.body_force);
  for (const auto& body : disc.problem.solids) has_body_force = has_body_force || body.body_force;
  if (has_body_force) {
    load = body_force_load(disc, Share{&operators.ownership.owner, operators.rank}, t);
    sum_over_ranks(operators.comm, load);
  }
  for (const auto& [name, functional] : operators.openings) {
    const auto& pressure = disc.problem.boundary.at(name).pressure;
    if (pressure) load -= pressure(t) * functional;
  }
  return load;
}

/// This rank's share of convection(b) x; nothing where has_convection says so.
template <int dim>
Eigen::VectorXd convection_of(const Discretisation<dim>& disc, const Operators<dim>& operators,
                              const Eigen::VectorXd& b, const Eigen::VectorXd& x) {
  Eigen::VectorXd convection = Eigen::VectorXd::Zero(x.size());
  if (has_convection(disc))
    visit_convection(disc, operators, b,
                     [&](int row, int column, double value) { convection[row] += value * x[column]; });
  return convection;
}

/// This rank's share of the kinetic power (b x, x) through openings. The rest of the convection does no work
/// on a domain at rest; where the domain moves it is part of the growth of the kinetic energy.
template <int dim>
double carried_power(const Discretisation<dim>& disc, const Operators<dim>& operators,
                     const Eigen::VectorXd& b, const Eigen::VectorXd& x) {
  double power = 0;
  visit_opening_convection(disc, operators, b,
                           [&](int row, int column, double value) { power += x[row] * value * x[column]; });
  return power;
}

/// This rank's share of the penalty on velocity jumps that the local velocity scales, times x.
template <int dim>
Eigen::VectorXd jumps_of(const Discretisation<dim>& disc, const Operators<dim>& operators,
                         const Eigen::VectorXd& b, const Eigen::VectorXd& x) {
  Eigen::VectorXd jumps = Eigen::VectorXd::Zero(x.size());
  visit_velocity_jumps<dim>(disc, operators.velocity_jumps, b,
                            [&](int row, int column, double value) { jumps[row] += value * x[column]; });
  return jumps;
}

template <int dim>
double imposed_fluid_value(const ConstrainedUnknown<dim>& constrained, double t) {
  if (!constrained.condition || !constrained.condition->velocity) return 0.0;
  return constrained.condition->velocity(constrained.position, t)[constrained.component];
}

} // namespace

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

std::array<double, 3> bdf_coefficients(TimeScheme scheme, int step, double ratio) {
  if (scheme == TimeScheme::bdf1 || step <= 1) return {1.0, -1.0, 0.0};
  return {(1 + 2 * ratio) / (1 + ratio), -(1 + ratio), ratio * ratio / (1 + ratio)};
}

template <int dim>
TimeStepper<dim>::TimeStepper(const Discretisation<dim>& disc, const Operators<dim>& operators,
                              TimeScheme scheme, double dt, int factor_every, PhaseTimer& timer,
                              const NewtonSettings& newton)
    : disc_(disc),
      operators_(operators),
      scheme_(scheme),
      dt_(dt),
      timer_(timer),
      newton_(newton),
      system_(disc, operators, factor_every, timer) {}

template <int dim>
void TimeStepper<dim>::set_contact(ContactForce contact) {
  contact_ = std::move(contact);
  // The film is known to every rank and enters once.
  if (operators_.rank != 0) contact_->stiffness.setZero();
  system_.add_stiffness(&contact_->stiffness);
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
  for (const auto& node : disc_.imposed) {
    const auto target = imposed_displacement(disc_, node, t);
    for (int c = 0; c < dim; ++c) {
      const int u = node.unknown + c;
      // The scheme's derivative of the exact displacement, so that the displacement itself is met exactly.
      rhs[u] = (alpha[0] * target[c] + alpha[1] * state.d[0][u] + alpha[2] * state.d[1][u]) / dt_;
    }
  }
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
    if (contact_) rhs += contact_->stiffness * (history_d / alpha[0]);
    sum_over_ranks(operators_.comm, rhs);
    rhs += loads(t);
    impose(state, alpha, t, rhs);
    convecting_ = scheme_ == TimeScheme::bdf2 && step > 1
                      ? Eigen::VectorXd((1 + ratio) * state.x[0] - ratio * state.x[1])
                      : state.x[0];
  }
  system_.assemble({alpha[0] / dt_, dt_ / alpha[0]}, &convecting_);
  Eigen::VectorXd x;
  try {
    if (operators_.has_nonlinear_solid) {
      x = convecting_;
      iterations_ = solve_newton<dim>(system_, disc_, operators_,
                                      {{dt_ / alpha[0], 1.0}, -history_d / alpha[0], state.d[0]}, rhs,
                                      newton_, step, true, x);
    } else {
      x = system_.solve(rhs, step);
      iterations_ = 1;
    }
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
  const int fluid = disc_.fluid_unknowns(), solid = disc_.unknowns() - fluid;
  state.d[0].tail(solid) = (dt_ * x.tail(solid) - history_d.tail(solid)) / alpha[0];
  state.x[0] = std::move(x);
  state.step = step;
  state.time = t;
  alpha_ = alpha;
}

template <int dim>
Eigen::VectorXd TimeStepper<dim>::residual(const State& state) const {
  const auto& x = state.x[0];
  const Eigen::VectorXd rate = (alpha_[0] * x + alpha_[1] * state.x[1] + alpha_[2] * older_x_) / dt_;
  Eigen::VectorXd sum = operators_.mass * rate + operators_.physical * x + operators_.stabilisation * x +
                        operators_.damping * x + operators_.stiffness * state.d[0] +
                        convection_of(disc_, operators_, convecting_, x) +
                        jumps_of(disc_, operators_, convecting_, x);
  if (contact_) sum += contact_->stiffness * state.d[0];
  sum_over_ranks(operators_.comm, sum);
  if (operators_.has_nonlinear_solid) {
    const auto solids = complete_response<dim>(disc_, operators_, state.d[0], x, {}, false);
    sum += solids.elastic + solids.viscous;
  }
  return sum - loads(state.time);
}

template <int dim>
EnergyTerms TimeStepper<dim>::energy(const State& state) const {
  const auto& x = state.x[0];
  const Eigen::VectorXd physical = operators_.physical * x,
                        penalties =
                            operators_.stabilisation * x + jumps_of(disc_, operators_, convecting_, x),
                        damping = operators_.damping * x, elastic = operators_.stiffness * state.d[0];
  const Eigen::VectorXd reaction = residual(state);
  const Eigen::VectorXd load = loads_at(disc_, operators_, state.time);

  Eigen::VectorXd sums(7);
  sums << x.dot(physical), x.dot(penalties), x.dot(damping), 0.5 * x.dot(operators_.mass * x),
      0.5 * state.d[0].dot(elastic), carried_power(disc_, operators_, convecting_, x),
      contact_ ? x.dot(contact_->stiffness * state.d[0]) : 0.0;
  sum_over_ranks(operators_.comm, sums);
  EnergyTerms terms;
  terms.viscous = sums[0];
  terms.stabilisation = sums[1];
  terms.damping = sums[2];
  terms.kinetic = sums[3];
  terms.elastic = sums[4];
  if (contact_) terms.contact = sums[6] - x.dot(contact_->load);
  if (operators_.has_nonlinear_solid) {
    const auto solids = complete_response<dim>(disc_, operators_, state.d[0], x, {}, false);
    terms.elastic += solids.energy;
    terms.damping += x.dot(solids.viscous);
  }
  terms.carried = sums[5];
  for (const auto& node : disc_.imposed)
    for (int c = 0; c < dim; ++c) terms.holder += reaction[node.unknown + c] * x[node.unknown + c];
  for (const auto& constrained : disc_.constrained)
    terms.boundary += reaction[constrained.unknown] * x[constrained.unknown];
  for (const auto& [name, functional] : operators_.openings) {
    const auto& pressure = disc_.problem.boundary.at(name).pressure;
    if (pressure) terms.opening -= pressure(state.time) * functional.dot(x);
  }
  terms.body = load.dot(x) - terms.opening;
  return terms;
}

namespace {

/// The steady state under the loads and imposed values `rhs`, from `x`, which a failure leaves as it was;
/// `balanced`: the one under the loads before.
template <int dim>
int steady_at_load(LinearSystem<dim>& system, const Discretisation<dim>& disc,
                   const Operators<dim>& operators, const Eigen::VectorXd& rhs, double tolerance,
                   int max_iterations, const LoadPath& path, const std::string& place,
                   const Eigen::VectorXd& balanced, Eigen::VectorXd& x) {
  const SolidMotion at_rest{{1.0, 0.0}, Eigen::VectorXd::Zero(disc.unknowns()), balanced};
  Eigen::VectorXd last = x;
  double change = 0;
  int solves = 0;
  for (int iteration = 1; iteration <= max_iterations; ++iteration) {
    system.assemble({0.0, 1.0, 0.0}, &last);
    Eigen::VectorXd next = last;
    if (operators.has_nonlinear_solid) {
      try {
        solves += solve_newton(system, disc, operators, at_rest, rhs, path.newton, iteration, false, next);
      } catch (const NumericsError& error) {
        throw NumericsError(std::string("the steady state was not reached: ") + error.what(), place,
                            "more load steps (LoadPath::load_steps), or more iterations");
      }
    } else {
      next = system.solve(rhs, iteration);
      ++solves;
    }
    change = (next - last).norm() / std::max(next.norm(), 1e-300);
    last = std::move(next);
    if (change < tolerance || disc.problem.flow == FlowModel::stokes) {
      x = std::move(last);
      return solves;
    }
  }
  throw NumericsError(
      "the Picard iteration for the steady state did not converge",
      std::to_string(max_iterations) + " iterations, relative change " + std::to_string(change),
      "a time-dependent run, or more iterations");
}

} // namespace

template <int dim>
int solve_steady(const Discretisation<dim>& disc, const Operators<dim>& operators, double tolerance,
                 int max_iterations, PhaseTimer& timer, Eigen::VectorXd& x, const LoadPath& path) {
  bool elastic = false;
  for (int unknown = disc.fluid_unknowns(); unknown < disc.unknowns(); ++unknown)
    elastic = elastic || !disc.is_constrained[unknown];
  if (elastic && !disc.cut.interface.empty())
    throw InputError("the steady state of elastic solids in a fluid is not computed directly",
                     "solids with nodes that are free to move, in contact with fluid",
                     "imposed solids in a fluid, or solids in vacuo; otherwise a run in time",
                     "FsiProblem::solids");
  LinearSystem<dim> system(disc, operators, 1, timer);
  Eigen::VectorXd full = loads_at(disc, operators, 0.0);
  for (const auto& constrained : disc.constrained)
    full[constrained.unknown] = imposed_fluid_value(constrained, 0.0);
  for (const auto& node : disc.imposed)
    full.template segment<dim>(node.unknown) = imposed_displacement(disc, node, 0.0);
  const int load_steps = operators.has_nonlinear_solid ? path.load_steps : 1;
  int solves = 0;
  Eigen::VectorXd before = x;
  for (int load = 1; load <= load_steps; ++load) {
    const Eigen::VectorXd rhs = full * (static_cast<double>(load) / load_steps);
    Eigen::VectorXd next = x;
    if (load > 1) next += x - before; // along the path so far
    solves +=
        steady_at_load(system, disc, operators, rhs, tolerance, max_iterations, path,
                       "load step " + std::to_string(load) + " of " + std::to_string(load_steps), x, next);
    before = std::exchange(x, std::move(next));
  }
  return solves;
}

template <int dim>
Eigen::VectorXd steady_residual(const Discretisation<dim>& disc, const Operators<dim>& operators,
                                const Eigen::VectorXd& x) {
  Eigen::VectorXd sum = operators.physical * x + operators.stabilisation * x + operators.stiffness * x +
                        convection_of(disc, operators, x, x) + jumps_of(disc, operators, x, x);
  sum_over_ranks(operators.comm, sum);
  if (operators.has_nonlinear_solid)
    sum += complete_response<dim>(disc, operators, x, Eigen::VectorXd::Zero(x.size()), {}, false).elastic;
  return sum - loads_at(disc, operators, 0.0);
}

template Point<2> imposed_displacement(const Discretisation<2>&, const ImposedNode<2>&, double);
template State initial_state(const Discretisation<2>&);
template class TimeStepper<2>;
template int solve_steady(const Discretisation<2>&, const Operators<2>&, double, int, PhaseTimer&,
                          Eigen::VectorXd&, const LoadPath&);
template Eigen::VectorXd steady_residual(const Discretisation<2>&, const Operators<2>&,
                                         const Eigen::VectorXd&);

} // namespace undula::fom
