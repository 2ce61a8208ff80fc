#include "fom/system/newton.hpp"
#include "fom/time/step_parts.hpp"
#include "fom/time/time_stepper.hpp"

namespace undula::fom {

template <int dim>
Eigen::VectorXd TimeStepper<dim>::residual(const State& state) const {
  const auto& x = state.x[0];
  const Eigen::VectorXd rate = (alpha_[0] * x + alpha_[1] * state.x[1] + alpha_[2] * older_x_) / dt_;
  Eigen::VectorXd sum = operators_.mass * rate + operators_.physical * x + operators_.stabilisation * x +
                        operators_.damping * x + operators_.stiffness * state.d[0] +
                        convection_of(disc_, operators_, convecting_, x) +
                        jumps_of(disc_, operators_, convecting_, x);
  if (adds_contact()) sum += contact_->stiffness * state.d[0];
  sum_over_ranks(operators_.comm, sum);
  if (operators_.has_nonlinear_solid) {
    const auto solids = complete_response<dim>(disc_, operators_, state.d[0], x, {}, false);
    sum += solids.elastic + solids.viscous;
  }
  if (skin_) sum -= skin_there_.loads + skin_there_.contact;
  return sum - loads(state.time);
}

template <int dim>
EnergyTerms TimeStepper<dim>::energy(const State& state, const Eigen::VectorXd& residual) const {
  const auto& x = state.x[0];
  const Eigen::VectorXd physical = operators_.physical * x,
                        penalties =
                            operators_.stabilisation * x + jumps_of(disc_, operators_, convecting_, x),
                        damping = operators_.damping * x, elastic = operators_.stiffness * state.d[0];
  const Eigen::VectorXd load = loads_at(disc_, operators_, state.time);

  const bool second = alpha_[2] != 0;
  const auto roughness = [&](const Eigen::VectorXd& now, const Eigen::VectorXd& before,
                             const Eigen::VectorXd& older) -> Eigen::VectorXd {
    if (second) return now - 2 * before + older;
    return now - before;
  };
  const Eigen::VectorXd rough_x = roughness(x, state.x[1], older_x_),
                        rough_d = roughness(state.d[0], state.d[1], older_d_);
  Eigen::VectorXd sums(8);
  sums << x.dot(physical), x.dot(penalties), x.dot(damping), 0.5 * x.dot(operators_.mass * x),
      0.5 * state.d[0].dot(elastic), carried_power(disc_, operators_, convecting_, x),
      adds_contact() ? x.dot(contact_->stiffness * state.d[0]) : 0.0,
      (rough_x.dot(operators_.mass * rough_x) + rough_d.dot(operators_.stiffness * rough_d)) /
          ((second ? 4 : 2) * dt_);
  sum_over_ranks(operators_.comm, sums);
  EnergyTerms terms;
  terms.viscous = sums[0];
  terms.stabilisation = sums[1];
  terms.damping = sums[2];
  terms.kinetic = sums[3];
  terms.elastic = sums[4];
  terms.scheme = sums[7];
  if (contact_) terms.contact = sums[6] - x.dot(contact_->load);
  if (skin_) terms.contact -= x.dot(skin_there_.contact);
  if (operators_.has_nonlinear_solid) {
    const auto solids = complete_response<dim>(disc_, operators_, state.d[0], x, {}, false);
    terms.elastic += solids.energy;
    terms.damping += x.dot(solids.viscous);
  }
  terms.carried = sums[5];
  for (const auto& node : disc_.imposed)
    for (int c = 0; c < dim; ++c) terms.holder += residual[node.unknown + c] * x[node.unknown + c];
  for (const auto& constrained : disc_.constrained)
    terms.boundary += residual[constrained.unknown] * x[constrained.unknown];
  for (const auto& [name, functional] : operators_.openings) {
    const auto& pressure = disc_.problem.boundary.at(name).pressure;
    if (pressure) terms.opening -= pressure(state.time) * functional.dot(x);
  }
  terms.body = load.dot(x) - terms.opening;
  if (skin_) terms.body += x.dot(skin_there_.loads);
  return terms;
}

template Eigen::VectorXd TimeStepper<2>::residual(const State&) const;
template EnergyTerms TimeStepper<2>::energy(const State&, const Eigen::VectorXd&) const;

template Eigen::VectorXd TimeStepper<3>::residual(const State&) const;
template EnergyTerms TimeStepper<3>::energy(const State&, const Eigen::VectorXd&) const;

} // namespace undula::fom
