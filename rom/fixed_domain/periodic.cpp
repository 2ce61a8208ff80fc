#include "rom/fixed_domain/periodic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rom/base/error.hpp"
#include "rom/base/gmres.hpp"
#include "rom/fixed_domain/time_march.hpp"

namespace undula::rom {
namespace {

// The same signal with more or fewer coefficients.
Eigen::MatrixXd resized(const Eigen::MatrixXd& coefficients, Eigen::Index columns) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(coefficients.rows(), columns);
  const auto kept = std::min(columns, coefficients.cols());
  result.leftCols(kept) = coefficients.leftCols(kept);
  return result;
}

} // namespace

struct PeriodicSolver::Linearisation {
  Eigen::MatrixXd values;       ///< nu x points: u
  Eigen::MatrixXd extrapolated; ///< nu x points: u*
  Eigen::MatrixXd by_advected;  ///< C(u*) at every point
  Eigen::MatrixXd by_advector;  ///< derivative with respect to u*
  Eigen::MatrixXd force;        ///< nu x coefficients: of C(u*) u
};

PeriodicSolver::PeriodicSolver(const Operators& operators, double frequency_Hz, int steps_per_period,
                               const PeriodicOptions& options)
    : operators_(operators),
      frequency_(frequency_Hz),
      steps_per_period_(steps_per_period),
      options_(options),
      convection_(operators.convection),
      resolvent_(operators, frequency_Hz, steps_per_period),
      harmonics_(steps_per_period, options.first_harmonics) {
  if (!(frequency_Hz > 0) || !std::isfinite(frequency_Hz))
    throw InputError("the frequency must be positive", std::to_string(frequency_Hz) + " Hz", "> 0",
                     "frequency");
  if (steps_per_period < 4)
    throw InputError("too few time steps per period", std::to_string(steps_per_period), "at least 4",
                     "steps per period");
  resolvent_.extend(harmonics_.harmonics());
  unit_stroke_ = -resolvent_.solve(resolvent_.holder_force(harmonics_.coefficients()));
  unit_head_ = -resolvent_.solve(resolvent_.head_force(harmonics_.coefficients()));
}

Eigen::MatrixXd PeriodicSolver::residual(const Eigen::MatrixXd& u, const Eigen::MatrixXd& linear_answer,
                                         Linearisation& at) const {
  at.values.noalias() = u * harmonics_.synthesis();
  at.extrapolated.noalias() = u * harmonics_.extrapolated_synthesis();
  convection_.matrices(at.extrapolated, at.by_advected);
  Eigen::MatrixXd force;
  convection_.apply(at.by_advected, at.values, force);
  at.force.noalias() = force * harmonics_.analysis();
  return u - linear_answer + resolvent_.velocity_response(at.force);
}

bool PeriodicSolver::newton(double stroke, double head, PeriodicState& state) {
  const int nu = operators_.velocity_modes;
  auto& u = state.velocity;
  for (;;) { // adds harmonics until the tail is small
    const int columns = harmonics_.coefficients();
    resolvent_.extend(harmonics_.harmonics());
    const Eigen::MatrixXd linear_state = stroke * unit_stroke_ + head * unit_head_;
    const Eigen::MatrixXd linear_answer = resized(linear_state.topRows(nu), columns);
    u = u.size() > 0 ? resized(u, columns) : linear_answer;
    Linearisation at;
    Eigen::MatrixXd r = residual(u, linear_answer, at);
    const auto relative = [&] { return r.norm() / std::max(u.norm(), 1e-300); };
    const auto derivative = [&](const Eigen::MatrixXd& in, Eigen::MatrixXd& out) {
      Eigen::MatrixXd product;
      convection_.apply(at.by_advected, in * harmonics_.synthesis(), product);
      convection_.add_derivative(at.by_advector, in * harmonics_.extrapolated_synthesis(), product);
      out = in + resolvent_.velocity_response(product * harmonics_.analysis());
    };
    state.residual = r.norm() == 0 ? 0.0 : relative();
    for (int iteration = 0; !(state.residual <= options_.tolerance); ++iteration) { // nan is no solution
      if (iteration == options_.newton_iterations || !std::isfinite(state.residual)) return false;
      convection_.derivatives(at.values, at.by_advector);
      // Newton's own error is about the square of the residual: the inner solve needs no more than that.
      const double inner = std::clamp(0.1 * state.residual, 0.3 * options_.tolerance / state.residual, 0.1);
      Eigen::MatrixXd step;
      state.krylov_iterations +=
          gmres(derivative, r, step, std::min(inner, 0.1), options_.krylov_dimension).iterations;
      ++state.newton_iterations;
      const Eigen::MatrixXd start = u;
      const double before = r.norm();
      double length = 1;
      for (; length > 0.05; length *= 0.5) { // shorter where the full step makes it worse
        u = start - length * step;
        r = residual(u, linear_answer, at);
        if (r.norm() < (1 - 0.1 * length) * before) break;
      }
      if (length <= 0.05) return false;
      state.residual = relative();
    }
    const double tail = u.rightCols(std::min<Eigen::Index>(4, u.cols())).norm() / std::max(u.norm(), 1e-300);
    if (!std::isfinite(tail)) return false;
    if (harmonics_.complete() || tail <= options_.tail_tolerance) {
      finish(linear_state, at.force, state);
      return state.y.allFinite();
    }
    harmonics_ =
        Harmonics(steps_per_period_, harmonics_.harmonics() + std::max(4, harmonics_.harmonics() / 3));
  }
}

void PeriodicSolver::finish(const Eigen::MatrixXd& linear_state, const Eigen::MatrixXd& convective_force,
                            PeriodicState& state) const {
  Eigen::MatrixXd total = Eigen::MatrixXd::Zero(linear_state.rows(), convective_force.cols());
  total.topRows(operators_.velocity_modes) = convective_force;
  state.y = resized(linear_state, total.cols()) - resolvent_.solve(total);
  state.displacement = resolvent_.displacement(state.y);
  state.y.bottomRows(operators_.displacement_modes).col(0).setZero(); // the membrane's velocity has no mean
  state.velocity = state.y.topRows(operators_.velocity_modes);
}

PeriodicState PeriodicSolver::solve(double stroke_cm, double head, const Eigen::MatrixXd& guess) {
  PeriodicState state;
  state.velocity = guess;
  bool found = options_.direct && newton(stroke_cm, head, state);
  if (options_.direct && !found &&
      guess.size() > 0) { // a misleading guess: once more, from the linear answer
    state.velocity.resize(0, 0);
    found = newton(stroke_cm, head, state);
  }
  if (found) {
    state.direct = state.converged = true;
  } else if (options_.march_periods == 0 || !march({frequency_, stroke_cm, head}, state)) {
    state.velocity = Eigen::MatrixXd::Zero(operators_.velocity_modes, 1);
    state.y = Eigen::MatrixXd::Zero(operators_.mass.rows(), 1);
    state.displacement = Eigen::MatrixXd::Zero(operators_.displacement_modes, 1);
    if (options_.march_periods > 0) // asked for an answer, and there is none
      state.mean_outflow = state.mean_inflow = std::numeric_limits<double>::quiet_NaN();
    return state;
  }
  state.mean_outflow = operators_.outflow.dot(state.velocity.col(0));
  state.mean_inflow = operators_.inflow.dot(state.velocity.col(0));
  // A head beyond all reason overflows on the way to the flow.
  if (!std::isfinite(state.mean_outflow) || !std::isfinite(state.mean_inflow)) state.converged = false;
  return state;
}

bool PeriodicSolver::march(const Drive& drive, PeriodicState& state) try {
  constexpr double ramp_periods = 2;
  TimeMarch march(operators_, drive, steps_per_period_, ramp_periods);
  std::vector<double> means;
  state.converged = false;
  while (state.marched_periods < options_.march_periods && !state.converged) {
    const auto record = march.period();
    means.push_back(record.mean_outflow);
    ++state.marched_periods;
    state.residual = record.change;
    if (!std::isfinite(record.change)) break;
    state.converged = state.marched_periods > ramp_periods + 1 && record.change <= options_.march_tolerance;
  }
  const auto last = means.end() - std::min<std::ptrdiff_t>(options_.spread_periods, std::ssize(means));
  const auto [low, high] = std::minmax_element(last, means.end());
  state.outflow_spread = *high - *low;
  // Column j of a trajectory is at phase (j + 1) dt; coefficients count from phase 0.
  const Harmonics all(steps_per_period_, steps_per_period_ / 2);
  const auto coefficients = [&](const Eigen::MatrixXd& trajectory) -> Eigen::MatrixXd {
    Eigen::MatrixXd shifted(trajectory.rows(), trajectory.cols());
    shifted << trajectory.rightCols(1), trajectory.leftCols(trajectory.cols() - 1);
    return shifted * all.analysis();
  };
  state.y = coefficients(march.trajectory());
  state.displacement = coefficients(march.displacement_trajectory());
  state.velocity = state.y.topRows(operators_.velocity_modes);
  return true;
} catch (const NumericsError&) { // a head or stroke beyond all reason
  state.converged = false;
  return false;
}

Eigen::MatrixXd PeriodicSolver::at_steps(const Eigen::MatrixXd& coefficients) const {
  return coefficients *
         Harmonics::synthesis_at_steps(steps_per_period_, static_cast<int>(coefficients.cols()));
}

} // namespace undula::rom
