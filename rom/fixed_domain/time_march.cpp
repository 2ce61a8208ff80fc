#include "rom/fixed_domain/time_march.hpp"

#include <Eigen/LU>
#include <cmath>
#include <utility>

#include "rom/base/error.hpp"

namespace undula::rom {

TimeMarch::TimeMarch(const Operators& operators, const Drive& drive, int steps_per_period,
                     double ramp_periods)
    : operators_(operators), drive_(drive), steps_per_period_(steps_per_period) {
  if (!(drive.frequency > 0) || !std::isfinite(drive.frequency))
    throw InputError("the frequency must be positive", std::to_string(drive.frequency) + " Hz", "> 0",
                     "frequency");
  if (steps_per_period < 4)
    throw InputError("too few time steps per period", std::to_string(steps_per_period), "at least 4",
                     "steps per period");
  dt_ = 1.0 / (drive.frequency * steps_per_period);
  ramp_time_ = ramp_periods / drive.frequency;
  state_ = previous_state_ = Eigen::VectorXd::Zero(operators.mass.rows());
  displacement_ = previous_displacement_ = Eigen::VectorXd::Zero(operators.displacement_modes);
}

void TimeMarch::start_from(const Eigen::MatrixXd& state, const Eigen::MatrixXd& displacement) {
  previous_state_ = state.col(0);
  state_ = state.col(1);
  previous_displacement_ = displacement.col(0);
  displacement_ = displacement.col(1);
  has_history_ = true;
  // The holder has been moving at full stroke for ever.
  const long ramp_steps = static_cast<long>(std::ceil(ramp_time_ / dt_));
  steps_ = (ramp_steps / steps_per_period_ + 2) * steps_per_period_;
}

double TimeMarch::holder(long step) const {
  if (step < 0) return 0;
  // The phase is reduced to one period before it is scaled, so that late periods are as exact as the first.
  const double phase = static_cast<double>(step % steps_per_period_) / steps_per_period_;
  return drive_.stroke * ramp(static_cast<double>(step) * dt_, ramp_time_) *
         std::sin(2 * std::numbers::pi * phase);
}

double TimeMarch::holder_velocity(long step) const {
  if (step <= 0) return 0;
  const auto& alpha = step == 1 ? bdf1_weights : bdf2_weights;
  return (alpha[0] * holder(step) + alpha[1] * holder(step - 1) + alpha[2] * holder(step - 2)) / dt_;
}

TimeMarch::Imposed TimeMarch::imposed(long step) const {
  const auto& alpha = step == 1 ? bdf1_weights : bdf2_weights;
  const double acceleration = (alpha[0] * holder_velocity(step) + alpha[1] * holder_velocity(step - 1) +
                               alpha[2] * holder_velocity(step - 2)) /
                              dt_;
  return {holder(step), holder_velocity(step), acceleration,
          drive_.head * ramp(static_cast<double>(step) * dt_, ramp_time_)};
}

Eigen::VectorXd TimeMarch::forcing(const Imposed& now) const {
  return operators_.imposed_mass * now.acceleration + operators_.imposed_linear * now.velocity +
         operators_.imposed_stiffness * now.displacement + operators_.head * now.head;
}

double TimeMarch::kinetic_energy() const { return 0.5 * state_.dot(operators_.mass * state_); }
double TimeMarch::elastic_energy() const {
  return 0.5 * displacement_.dot(operators_.stiffness * displacement_);
}

void TimeMarch::step() {
  const int nu = operators_.velocity_modes, nv = operators_.displacement_modes;
  const auto& alpha = has_history_ ? bdf2_weights : bdf1_weights;
  const Eigen::VectorXd advecting =
      has_history_ ? Eigen::VectorXd(2 * state_.head(nu) - previous_state_.head(nu)) : state_.head(nu);

  Eigen::MatrixXd matrix = (alpha[0] / dt_) * operators_.mass + operators_.linear;
  matrix.bottomRightCorner(nv, nv) += (dt_ / alpha[0]) * operators_.stiffness;
  for (int k = 0; k < nu; ++k)
    matrix.topLeftCorner(nu, nu) += advecting[k] * operators_.convection[static_cast<std::size_t>(k)];

  const Eigen::VectorXd force = forcing(imposed(steps_ + 1));
  const Eigen::VectorXd history = (alpha[1] * state_ + alpha[2] * previous_state_) / dt_;
  const Eigen::VectorXd displacement_history = alpha[1] * displacement_ + alpha[2] * previous_displacement_;
  Eigen::VectorXd right_side = -force - operators_.mass * history;
  right_side.tail(nv) += operators_.stiffness * displacement_history / alpha[0];

  previous_state_ = std::exchange(state_, matrix.partialPivLu().solve(right_side));
  const Eigen::VectorXd moved = (dt_ * state_.tail(nv) - displacement_history) / alpha[0];
  previous_displacement_ = std::exchange(displacement_, moved);
  ++steps_;
  has_history_ = true;
  if (!std::isfinite(state_.squaredNorm())) // an energy that overflows is no state either
    throw NumericsError(
        "the reduced model's state is not finite",
        "step " + std::to_string(steps_) + ", t = " + std::to_string(time()) + " s",
        "a longer ramp, more steps per period, or an operating point inside the training box");
  power_in_ = -state_.dot(force);
  dissipation_ = state_.dot(operators_.linear * state_);
}

PeriodRecord TimeMarch::period() {
  const int nu = operators_.velocity_modes;
  PeriodRecord record;
  const Eigen::MatrixXd before = std::move(trajectory_);
  trajectory_.resize(state_.size(), steps_per_period_);
  displacement_trajectory_.resize(displacement_.size(), steps_per_period_);
  const double energy = kinetic_energy() + elastic_energy();
  for (int n = 0; n < steps_per_period_; ++n) {
    step();
    trajectory_.col(n) = state_;
    displacement_trajectory_.col(n) = displacement_;
    record.mean_outflow += operators_.outflow.dot(state_.head(nu)) / steps_per_period_;
    record.mean_inflow += operators_.inflow.dot(state_.head(nu)) / steps_per_period_;
    record.work_in += power_in_ * dt_;
    record.dissipated += dissipation_ * dt_;
  }
  record.energy_gain = kinetic_energy() + elastic_energy() - energy;
  const double scale = std::max(std::abs(record.work_in), record.dissipated);
  if (scale > 0)
    record.balance_defect = std::abs(record.work_in - record.dissipated - record.energy_gain) / scale;
  record.change = 1;
  if (before.size() > 0) {
    const Eigen::MatrixXd difference = trajectory_ - before;
    const double size = (trajectory_.cwiseProduct(operators_.mass * trajectory_)).sum();
    const double distance = (difference.cwiseProduct(operators_.mass * difference)).sum();
    record.change = size > 0 ? std::sqrt(std::max(0.0, distance) / size) : 0.0;
  }
  return record;
}

} // namespace undula::rom
