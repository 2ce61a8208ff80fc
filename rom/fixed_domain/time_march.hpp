// The plain march of the reduced model in time: the scheme of the full-order model, step by step.
#pragma once

#include <Eigen/Core>

#include "rom/fixed_domain/drive.hpp"
#include "rom/fixed_domain/model.hpp"

namespace undula::rom {

/// Means and balances over one period.
struct PeriodRecord {
  double mean_outflow = 0; ///< cm^3/s
  double mean_inflow = 0;  ///< cm^3/s
  double work_in = 0;      ///< erg, done by the holder and the head on the fluid and the membrane
  double dissipated = 0;   ///< erg, y . K y integrated
  double energy_gain = 0;  ///< erg, kinetic plus elastic energy at the end minus at the beginning
  /// |work_in - dissipated - energy_gain| over the larger of |work_in|, dissipated: what the scheme itself
  /// takes.
  double balance_defect = 0;
  double change = 0; ///< relative distance of the trajectory from that of the period before, in the mass norm
};

/// BDF2 (BDF1 in the first step), semi-implicit: C(2 u^n - u^{n-1}) u^{n+1}. The displacement is eliminated
/// by alpha_0 d^{n+1} + alpha_1 d^n + alpha_2 d^{n-1} = dt v^{n+1}; the imposed velocity and acceleration are
/// the same differences of the exact imposed displacement. Starts from rest at t = 0; stroke and head rise
/// smoothly over `ramp_periods`. dt = 1 / (frequency * steps_per_period).
class TimeMarch {
public:
  /// Keeps a reference to `operators`. Throws InputError for a frequency that is not positive or fewer than 4
  /// steps.
  TimeMarch(const Operators& operators, const Drive& drive, int steps_per_period, double ramp_periods);

  /// Goes on from given levels instead of rest (step counter at a whole number of periods after the ramp):
  /// columns of `state` (N x 2) and `displacement` (nv x 2) are the levels n - 1 and n.
  void start_from(const Eigen::MatrixXd& state, const Eigen::MatrixXd& displacement);

  /// One time step. Throws NumericsError when the state is no longer finite.
  void step();

  /// steps_per_period steps; trajectory() then holds them.
  PeriodRecord period();

  /// Steps of the last period(): N x steps_per_period and nv x steps_per_period; column j is at phase (j + 1)
  /// dt.
  const Eigen::MatrixXd& trajectory() const { return trajectory_; }
  const Eigen::MatrixXd& displacement_trajectory() const { return displacement_trajectory_; }

  double time() const { return static_cast<double>(steps_) * dt_; }
  double time_step() const { return dt_; }
  long steps() const { return steps_; }
  const Eigen::VectorXd& state() const { return state_; }               ///< y^n, N
  const Eigen::VectorXd& displacement() const { return displacement_; } ///< a_d^n, nv
  double kinetic_energy() const;                                        ///< erg
  double elastic_energy() const;                                        ///< erg

private:
  struct Imposed {
    double displacement, velocity, acceleration, head;
  };
  double holder(long step) const; ///< exact imposed displacement, cm
  double holder_velocity(long step) const;
  Imposed imposed(long step) const;
  Eigen::VectorXd forcing(const Imposed& imposed) const;

  const Operators& operators_;
  Drive drive_;
  int steps_per_period_;
  double dt_, ramp_time_;
  long steps_ = 0;
  bool has_history_ = false; ///< two levels known: BDF2
  Eigen::VectorXd state_, previous_state_, displacement_, previous_displacement_;
  Eigen::MatrixXd trajectory_, displacement_trajectory_;
  double power_in_ = 0, dissipation_ = 0; ///< of the last step, erg/s
};

} // namespace undula::rom
