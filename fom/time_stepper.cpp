#include "fom/time_stepper.hpp"

#include <string>

#include "base/error.hpp"

namespace undula {

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

/// This rank's share of convection(b) x; nothing in Stokes flow.
template <int dim>
Eigen::VectorXd convection_of(const Discretisation<dim>& disc, const Operators<dim>& operators,
                              const Eigen::VectorXd& b, const Eigen::VectorXd& x) {
  Eigen::VectorXd convection = Eigen::VectorXd::Zero(x.size());
  if (disc.problem.flow == FlowModel::navier_stokes)
    visit_convection(disc, operators, b,
                     [&](int row, int column, double value) { convection[row] += value * x[column]; });
  return convection;
}

template <int dim>
double imposed_fluid_value(const ConstrainedUnknown<dim>& constrained, double t) {
  if (!constrained.condition || !constrained.condition->velocity) return 0.0;
  return constrained.condition->velocity(constrained.position, t)[constrained.component];
}

template <int dim>
Point<dim> imposed_displacement(const Discretisation<dim>& disc, const ImposedNode<dim>& node, double t) {
  const auto& field = disc.problem.solids[node.solid].imposed_displacement;
  return field ? field(node.position, t) : Point<dim>::Zero();
}

} // namespace

template <int dim>
State initial_state(const Discretisation<dim>& disc) {
  State state;
  for (auto* levels : {&state.x, &state.d})
    for (auto& level : *levels) level = Eigen::VectorXd::Zero(disc.unknowns());
  return state;
}

std::array<double, 3> bdf_coefficients(TimeScheme scheme, int step) {
  if (scheme == TimeScheme::bdf1 || step <= 1) return {1.0, -1.0, 0.0};
  return {1.5, -2.0, 0.5};
}

template <int dim>
TimeStepper<dim>::TimeStepper(const Discretisation<dim>& disc, const Operators<dim>& operators,
                              TimeScheme scheme, double dt, int factor_every, PhaseTimer& timer)
    : disc_(disc),
      operators_(operators),
      scheme_(scheme),
      dt_(dt),
      timer_(timer),
      system_(disc, operators, factor_every, timer) {}

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
  const int step = state.step + 1;
  const double t = step * dt_;
  const auto alpha = bdf_coefficients(scheme_, step);
  const Eigen::VectorXd history_d = alpha[1] * state.d[0] + alpha[2] * state.d[1];
  Eigen::VectorXd rhs;
  {
    const auto scope = timer_.measure("assemble");
    rhs = operators_.stiffness * (history_d / alpha[0]) -
          operators_.mass * ((alpha[1] * state.x[0] + alpha[2] * state.x[1]) / dt_);
    sum_over_ranks(operators_.comm, rhs);
    rhs += loads_at(disc_, operators_, t);
    impose(state, alpha, t, rhs);
    convecting_ =
        scheme_ == TimeScheme::bdf2 && step > 1 ? Eigen::VectorXd(2 * state.x[0] - state.x[1]) : state.x[0];
  }
  system_.assemble({alpha[0] / dt_, dt_ / alpha[0]}, &convecting_);
  Eigen::VectorXd x;
  try {
    x = system_.solve(rhs, step);
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
}

template <int dim>
Eigen::VectorXd TimeStepper<dim>::residual(const State& state) const {
  const auto alpha = bdf_coefficients(scheme_, state.step);
  const auto& x = state.x[0];
  const Eigen::VectorXd rate = (alpha[0] * x + alpha[1] * state.x[1] + alpha[2] * older_x_) / dt_;
  Eigen::VectorXd sum = operators_.mass * rate + operators_.physical * x + operators_.stabilisation * x +
                        operators_.damping * x + operators_.stiffness * state.d[0] +
                        convection_of(disc_, operators_, convecting_, x);
  sum_over_ranks(operators_.comm, sum);
  return sum - loads_at(disc_, operators_, state.time);
}

template <int dim>
EnergyTerms TimeStepper<dim>::energy(const State& state) const {
  const auto& x = state.x[0];
  const Eigen::VectorXd physical = operators_.physical * x, penalties = operators_.stabilisation * x,
                        damping = operators_.damping * x, elastic = operators_.stiffness * state.d[0];
  const Eigen::VectorXd convection = convection_of(disc_, operators_, convecting_, x);
  const Eigen::VectorXd reaction = residual(state);
  const Eigen::VectorXd load = loads_at(disc_, operators_, state.time);

  Eigen::VectorXd sums(6);
  sums << x.dot(physical), x.dot(penalties), x.dot(damping), 0.5 * x.dot(operators_.mass * x),
      0.5 * state.d[0].dot(elastic), x.dot(convection);
  sum_over_ranks(operators_.comm, sums);
  EnergyTerms terms;
  terms.viscous = sums[0];
  terms.stabilisation = sums[1];
  terms.damping = sums[2];
  terms.kinetic = sums[3];
  terms.elastic = sums[4];
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

template <int dim>
int solve_steady(const Discretisation<dim>& disc, const Operators<dim>& operators, double tolerance,
                 int max_iterations, PhaseTimer& timer, Eigen::VectorXd& x) {
  bool elastic = false;
  for (int unknown = disc.fluid_unknowns(); unknown < disc.unknowns(); ++unknown)
    elastic = elastic || !disc.is_constrained[unknown];
  if (elastic && !disc.cut.interface.empty())
    throw InputError("the steady state of elastic solids in a fluid is not computed directly",
                     "solids with nodes that are free to move, in contact with fluid",
                     "imposed solids in a fluid, or solids in vacuo; otherwise a run in time",
                     "FsiProblem::solids");
  LinearSystem<dim> system(disc, operators, 1, timer);
  Eigen::VectorXd rhs = loads_at(disc, operators, 0.0);
  for (const auto& constrained : disc.constrained)
    rhs[constrained.unknown] = imposed_fluid_value(constrained, 0.0);
  for (const auto& node : disc.imposed)
    rhs.template segment<dim>(node.unknown) = imposed_displacement(disc, node, 0.0);
  double change = 0;
  for (int iteration = 1; iteration <= max_iterations; ++iteration) {
    system.assemble({0.0, 1.0}, &x);
    Eigen::VectorXd next = system.solve(rhs, iteration);
    change = (next - x).norm() / std::max(next.norm(), 1e-300);
    x = std::move(next);
    if (change < tolerance || disc.problem.flow == FlowModel::stokes) return iteration;
  }
  throw NumericsError(
      "the Picard iteration for the steady state did not converge",
      std::to_string(max_iterations) + " iterations, relative change " + std::to_string(change),
      "a time-dependent run, or more iterations");
}

template <int dim>
Eigen::VectorXd steady_residual(const Discretisation<dim>& disc, const Operators<dim>& operators,
                                const Eigen::VectorXd& x) {
  Eigen::VectorXd sum = operators.physical * x + operators.stabilisation * x + operators.damping * x +
                        operators.stiffness * x + convection_of(disc, operators, x, x);
  sum_over_ranks(operators.comm, sum);
  return sum - loads_at(disc, operators, 0.0);
}

template State initial_state(const Discretisation<2>&);
template class TimeStepper<2>;
template int solve_steady(const Discretisation<2>&, const Operators<2>&, double, int, PhaseTimer&,
                          Eigen::VectorXd&);
template Eigen::VectorXd steady_residual(const Discretisation<2>&, const Operators<2>&,
                                         const Eigen::VectorXd&);

} // namespace undula
