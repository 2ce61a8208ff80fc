// The periodic state of the reduced model, found directly.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "rom/fixed_domain/convection.hpp"
#include "rom/fixed_domain/drive.hpp"
#include "rom/fixed_domain/model.hpp"
#include "rom/fixed_domain/resolvent.hpp"

namespace undula::rom {

struct PeriodicOptions {
  double tolerance = 1e-8;      ///< of the velocity coefficients, relative
  double tail_tolerance = 1e-6; ///< amplitude left in the highest harmonics kept, relative
  int first_harmonics = 10;     ///< kept at first; more are added until the tail is small enough
  int newton_iterations = 12;
  int krylov_dimension = 60;
  bool direct = true;            ///< false: by the plain march at once (a check, slow)
  int march_periods = 200;       ///< at most, where the direct way fails; 0: no march, converged = false
  double march_tolerance = 1e-9; ///< change from period to period at which the march counts as periodic
  int spread_periods = 5;        ///< the spread of the march is over the means of so many last periods
};

/// A periodic (or, by the march, nearly periodic) state.
struct PeriodicState {
  Eigen::MatrixXd velocity;     ///< nu x coefficients, see Harmonics: coefficients of a_u
  Eigen::MatrixXd y;            ///< N x coefficients: a_u, a_p, a_v
  Eigen::MatrixXd displacement; ///< nv x coefficients: a_d
  double mean_outflow = 0;      ///< cm^3/s; nan where even the march broke down
  double mean_inflow = 0;       ///< cm^3/s
  bool converged = false;       ///< to the tolerance (direct), or periodic to march_tolerance (march)
  bool direct = false;          ///< false: the direct way failed or was not asked for, and this is the march
  double outflow_spread = 0;    ///< cm^3/s, max - min of the last periods' means; 0 if found directly
  double residual = 0;          ///< relative, of the periodic equations (direct) or last change (march)
  int newton_iterations = 0, krylov_iterations = 0, marched_periods = 0;
};

/// Periodic states of one model at one frequency. The BDF2 scheme over one period is a closed system for the
/// Fourier coefficients of the n_t steps: its linear part is diagonal in the harmonics (Resolvent),
/// convection is a product at points in time. Newton's method on
///     u + R_uu F(u) = u_lin,   F(u) = coefficients of C(u*) u,   u* the scheme's extrapolation,
/// with GMRES for the steps. The fixed point is that of the plain march: equal to it up to the two
/// tolerances.
class PeriodicSolver {
public:
  /// Keeps a reference to `operators`. Throws InputError for a frequency that is not positive or fewer than 4
  /// steps, NumericsError for a singular linear part.
  PeriodicSolver(const Operators& operators, double frequency_Hz, int steps_per_period,
                 const PeriodicOptions& options = {});

  /// `guess` (nu x any number of coefficients) starts Newton's method; empty: the linear answer.
  PeriodicState solve(double stroke_cm, double head, const Eigen::MatrixXd& guess = {});

  /// Values (rows x n_t) of coefficients at the steps t = 0, dt, ..., (n_t - 1) dt of the period.
  Eigen::MatrixXd at_steps(const Eigen::MatrixXd& coefficients) const;

private:
  struct Linearisation; // of convection, at the points in time
  bool newton(double stroke, double head, PeriodicState& state);
  Eigen::MatrixXd residual(const Eigen::MatrixXd& u, const Eigen::MatrixXd& linear_answer,
                           Linearisation& at) const;
  void finish(const Eigen::MatrixXd& linear_state, const Eigen::MatrixXd& convective_force,
              PeriodicState& state) const;
  bool march(const Drive& drive, PeriodicState& state); ///< false: it broke down

  const Operators& operators_;
  double frequency_;
  int steps_per_period_;
  PeriodicOptions options_;
  Convection convection_;
  Resolvent resolvent_;
  Harmonics harmonics_;
  Eigen::MatrixXd unit_stroke_, unit_head_; ///< N x coefficients: linear answers to 1 cm and to 1 dyn/cm^2
};

} // namespace undula::rom
