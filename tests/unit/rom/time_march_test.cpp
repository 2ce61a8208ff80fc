#include "rom/fixed_domain/time_march.hpp"

#include <gtest/gtest.h>

#include <complex>
#include <numbers>

#include "rom/base/error.hpp"
#include "synthetic_operators.hpp"

namespace undula::rom {
namespace {

using Complex = std::complex<double>;

// One membrane mode with added mass: m d'' + c d' + s d = -(holder's inertia) D''. Velocity and pressure
// modes are spectators: one damped velocity mode, no pressure.
struct Oscillator {
  double mass = 2.5, damping = 300.0, stiffness = 1.6e6, holder_mass = 1.2, holder_stiffness = 4e5;
};

Operators oscillator_operators(const Oscillator& p) {
  Operators o;
  o.velocity_modes = 1;
  o.displacement_modes = 1;
  o.mass = Eigen::Vector2d(1.0, p.mass).asDiagonal();
  o.linear = Eigen::Vector2d(100.0, p.damping).asDiagonal();
  o.stiffness = Eigen::MatrixXd::Constant(1, 1, p.stiffness);
  o.convection = {Eigen::MatrixXd::Zero(1, 1)};
  o.imposed_mass = Eigen::Vector2d(0, p.holder_mass);
  o.imposed_linear = Eigen::Vector2d::Zero();
  o.imposed_stiffness = Eigen::Vector2d(0, p.holder_stiffness);
  o.head = Eigen::Vector2d(1, 0);
  o.outflow = o.inflow = Eigen::VectorXd::Ones(1);
  return o;
}

Complex amplitude(const Oscillator& p, Complex rate) { // of d for D = Re(exp(i w t))
  return -(p.holder_mass * rate * rate + p.holder_stiffness) /
         (p.mass * rate * rate + p.damping * rate + p.stiffness);
}

// First Fourier coefficient of the last period's displacement; D = sin(w t) = Re(-i exp(i w t)).
Complex marched_amplitude(const Operators& o, double frequency, int steps, int periods) {
  TimeMarch march(o, {frequency, 1.0, 0.0}, steps, 3);
  for (int p = 0; p < periods; ++p) march.period();
  Complex sum = 0;
  for (int j = 0; j < steps; ++j)
    sum += march.displacement_trajectory()(0, j) *
           std::polar(2.0 / steps, -2 * std::numbers::pi * (j + 1) / steps);
  return sum * Complex(0, 1);
}

TEST(TimeMarch, OscillatorHasTheAmplitudeAndPhaseOfTheDiscreteSymbol) {
  const Oscillator p;
  const double frequency = 120;
  const int steps = 48;
  const Complex z = std::polar(1.0, 2 * std::numbers::pi / steps);
  const Complex rate = (1.5 - 2.0 / z + 0.5 / (z * z)) * (frequency * steps);
  const Complex exact = amplitude(p, rate);
  const Complex marched = marched_amplitude(oscillator_operators(p), frequency, steps, 80);
  EXPECT_LT(std::abs(marched - exact), 1e-10 * std::abs(exact));
}

TEST(TimeMarch, IsOfSecondOrderAgainstTheContinuousSolution) {
  const Oscillator p;
  const double frequency = 120;
  const Complex exact = amplitude(p, Complex(0, 2 * std::numbers::pi * frequency));
  const auto o = oscillator_operators(p);
  const double coarse = std::abs(marched_amplitude(o, frequency, 200, 60) - exact);
  const double fine = std::abs(marched_amplitude(o, frequency, 400, 60) - exact);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.05);
}

TEST(TimeMarch, FirstStepIsBdf1AndImposedDifferencesAreExact) {
  // From rest: (m / dt + c + dt s) v = -(holder_mass V'^1 + holder_stiffness D^1), V^1 = D^1 / dt, V'^1 = V^1
  // / dt.
  const Oscillator p;
  const double dt = 1.0 / (100.0 * 20);
  TimeMarch march(oscillator_operators(p), {100, 0.5, 7.0}, 20, 0);
  const auto o = oscillator_operators(p);
  TimeMarch one(o, {100, 0.5, 7.0}, 20, 0);
  one.step();
  const double holder = 0.5 * std::sin(2 * std::numbers::pi / 20);
  const double v = -(p.holder_mass * holder / (dt * dt) + p.holder_stiffness * holder) /
                   (p.mass / dt + p.damping + dt * p.stiffness);
  EXPECT_NEAR(one.state()[1], v, 1e-12 * std::abs(v));
  EXPECT_NEAR(one.displacement()[0], dt * v, 1e-12 * std::abs(dt * v));
  EXPECT_NEAR(one.state()[0], -7.0 / (1 / dt + 100), 1e-14);
}

TEST(TimeMarch, EnergyDecaysUnforced) {
  const auto o = synthetic_operators({12, 4, 3}, 30.0, 5);
  TimeMarch march(o, {100, 0.0, 0.0}, 96, 0);
  // A kick that satisfies the constraint: the state after a short forced run.
  TimeMarch kick(o, {100, 0.1, 3e4}, 96, 0);
  for (int n = 0; n < 40; ++n) kick.step();
  Eigen::MatrixXd y(o.mass.rows(), 2), d(3, 2);
  y.col(0) = kick.state();
  d.col(0) = kick.displacement();
  kick.step();
  y.col(1) = kick.state();
  d.col(1) = kick.displacement();
  march.start_from(y, d);
  march.step(); // the pressure forgets the force
  double energy = march.kinetic_energy() + march.elastic_energy();
  const double start = energy;
  ASSERT_GT(start, 100.0);
  for (int period = 0; period < 10; ++period) {
    const auto record = march.period();
    EXPECT_EQ(record.work_in, 0.0);
    EXPECT_LT(record.energy_gain, 0.0);
    energy += record.energy_gain;
  }
  EXPECT_LT(energy, 1e-3 * start);
  EXPECT_NEAR(energy, march.kinetic_energy() + march.elastic_energy(), 1e-12 * start);
}

TEST(TimeMarch, EnergyBalanceClosesWithTheTimeStep) {
  const auto o = synthetic_operators({12, 4, 3}, 10.0, 5);
  double defect[2];
  for (int i = 0; i < 2; ++i) {
    TimeMarch march(o, {100, 0.05, 2e4}, i == 0 ? 200 : 400, 2);
    PeriodRecord record;
    for (int period = 0; period < 40; ++period) record = march.period();
    ASSERT_LT(record.change, 1e-5);
    defect[i] = record.balance_defect;
  }
  EXPECT_LT(defect[0], 0.01);
  EXPECT_LT(defect[1], 0.4 * defect[0]);
}

TEST(TimeMarch, TwoHundredPeriodsWithoutDrift) {
  const auto o = synthetic_operators({16, 5, 4}, 30.0, 3);
  TimeMarch march(o, {110, 0.06, 2e4}, 48, 2);
  double at_100 = 0;
  PeriodRecord record;
  for (int period = 1; period <= 200; ++period) {
    record = march.period();
    if (period == 100) at_100 = record.mean_outflow;
  }
  ASSERT_GT(std::abs(at_100), 1.0);
  EXPECT_NEAR(record.mean_outflow, at_100, 1e-10 * std::abs(at_100));
  EXPECT_LT(record.change, 1e-11);
}

TEST(TimeMarch, RefusesWrongInputAndReportsABlowUp) {
  auto o = synthetic_operators({6, 2, 2}, 0.0);
  EXPECT_THROW(TimeMarch(o, {0, 1, 1}, 48, 2), InputError);
  EXPECT_THROW(TimeMarch(o, {100, 1, 1}, 3, 2), InputError);
  o.linear.topLeftCorner(6, 6).diagonal().array() -= 3e3; // gains energy
  TimeMarch march(o, {100, 0.1, 1e4}, 48, 0);
  EXPECT_THROW(
      {
        for (int period = 0; period < 200; ++period) march.period();
      },
      NumericsError);
}

} // namespace
} // namespace undula::rom
