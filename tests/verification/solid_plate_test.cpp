// Clamped plates in vacuo against thin-plate theory: deflection, first eigenfrequency, free oscillation in
// time.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cstdio>
#include <numbers>

#include "fom/time/steady.hpp"
#include "fom/time/time_stepper.hpp"
#include "tests/verification/support/eigenmodes.hpp"
#include "tests/verification/support/names.hpp"
#include "tests/verification/support/plate_theory.hpp"
#include "tests/verification/support/solid_meshes.hpp"

namespace undula::verification {
namespace {

constexpr double young = 1.686e7, density = 1.125; // g, cm, s

struct PlateProblem {
  Discretisation<2> disc;
  Operators<2> operators;
  int tip = -1; ///< unknown of the axial displacement at the inner edge, mid-plane
};

/// Ring inner <= r <= outer of thickness h, clamped at r = outer, with `nr` x 2 quadrilaterals. A body force
/// gives the load `pressure` per area of the mid-plane.
PlateProblem ring_plate(PhaseTimer& timer, double inner, double outer, double h, double poisson, int nr,
                        double pressure) {
  SolidBody<2> body;
  body.mesh = box({inner, -h / 2}, {outer, h / 2}, nr, 2);
  body.properties = {density, young, poisson, 0.0};
  body.imposed = [=](const Point<2>& x) { return x[0] > outer * (1 - 1e-9); };
  body.body_force = [=](const Point<2>&, double t) { return Point<2>(0.0, t <= 0 ? pressure / h : 0.0); };
  PlateProblem plate;
  plate.disc = discretise(in_vacuo(Space::axisymmetric, std::move(body)), CutOptions{});
  if (inner == 0) hold_component(plate.disc, 0, 0, [](const Point<2>& x) { return x[0] == 0; });
  plate.operators = build_operators(plate.disc, PETSC_COMM_SELF, timer);
  plate.tip = plate.disc.solid_unknown(0, node_at(plate.disc, 0, {inner, 0.0}), 1);
  return plate;
}

Eigen::VectorXd static_deflection(const PlateProblem& plate, PhaseTimer& timer) {
  Eigen::VectorXd d = Eigen::VectorXd::Zero(plate.disc.unknowns());
  solve_steady(plate.disc, plate.operators, 1e-10, 1, timer, d);
  return d;
}

struct PlateCase {
  const char* name;
  double inner, h, poisson;
};

class ClampedPlate : public testing::TestWithParam<PlateCase> {};

TEST_P(ClampedPlate, DeflectsAndVibratesAsThinPlateTheorySays) {
  const auto [name, inner, h, poisson] = GetParam();
  const PlateTheory theory{inner, 1.0, h, young, poisson, density};
  const double pressure = 10.0;
  PhaseTimer timer;
  // Elements as long as they are high, two through the thickness.
  const auto plate =
      ring_plate(timer, inner, 1.0, h, poisson, static_cast<int>(std::lround(2 * (1 - inner) / h)), pressure);
  const double deflection = static_deflection(plate, timer)[plate.tip];
  const double exact = theory.deflection(inner, pressure) + theory.shear_deflection(inner, pressure);
  const double omega = first_vibration(plate.disc, plate.operators).omega;
  const double exact_omega = theory.first_omega();
  std::printf("%s: w0 %.6e cm, exact %.6e (%+.3f %%); f1 %.4f Hz, exact %.4f (%+.3f %%)\n", name, deflection,
              exact, 100 * (deflection / exact - 1), omega / (2 * std::numbers::pi),
              exact_omega / (2 * std::numbers::pi), 100 * (omega / exact_omega - 1));
  EXPECT_NEAR(deflection, exact, 0.01 * exact);
  EXPECT_NEAR(omega, exact_omega, 0.01 * exact_omega);
}

INSTANTIATE_TEST_SUITE_P(Plates, ClampedPlate,
                         testing::Values(PlateCase{"disc_049", 0.0, 0.01, 0.49},
                                         PlateCase{"disc_04999", 0.0, 0.01, 0.4999},
                                         PlateCase{"disc_03", 0.0, 0.01, 0.3},
                                         PlateCase{"ring_049", 0.25, 0.01, 0.49},
                                         PlateCase{"ring_04999", 0.25, 0.01, 0.4999}),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(ThinPlateTheory, HasTheClassicalNumbersOfTheClampedDisc) {
  const PlateTheory disc{0.0, 2.0, 0.1, 3e6, 0.3, 1.5};
  const double stiffness = 3e6 * 1e-3 / (12 * 0.91);
  EXPECT_NEAR(disc.deflection(0, 7.0), 7.0 * 16 / (64 * stiffness), 1e-12);
  EXPECT_NEAR(disc.first_omega(), 10.2158 * std::sqrt(stiffness / (1.5 * 0.1 * 16)),
              1e-5 * disc.first_omega());
}

/// Released from its static deflection: no eigensolver in the loop.
TEST(ClampedDisc, OscillatesAtItsFirstFrequencyInTime) {
  const double h = 0.02;
  const PlateTheory theory{0.0, 1.0, h, young, 0.49, density};
  const double period = 2 * std::numbers::pi / theory.first_omega();
  PhaseTimer timer;
  const auto plate = ring_plate(timer, 0.0, 1.0, h, 0.49, 100, 10.0);
  State state = initial_state(plate.disc);
  state.d[0] = state.d[1] = static_deflection(plate, timer);
  const double dt = period / 100;
  TimeStepper<2> stepper(plate.disc, plate.operators, TimeScheme::bdf2, dt, 100, timer);
  std::vector<double> crossings;
  while (crossings.size() < 5 && state.step < 400) {
    stepper.advance(state);
    const double before = state.d[1][plate.tip], now = state.d[0][plate.tip];
    if ((before > 0) != (now > 0)) crossings.push_back(state.time - dt * now / (now - before));
  }
  ASSERT_EQ(crossings.size(), 5u);
  const double measured = (crossings[4] - crossings[0]) / 2;
  std::printf("free oscillation of the disc: f1 %.4f Hz, exact %.4f (%+.3f %%)\n", 1 / measured, 1 / period,
              100 * (period / measured - 1));
  EXPECT_NEAR(measured, period, 0.01 * period);
}

/// Loss of amplitude per period of a free mode at omega dt, from the scheme's amplification factor.
struct NumericalDamping {
  std::complex<double> factor; ///< z of y^{n+1} = z y^n
  double loss_per_period;
};
NumericalDamping numerical_damping(TimeScheme scheme, double omega_dt) {
  const std::complex<double> lambda(0, omega_dt);
  const auto z = scheme == TimeScheme::bdf1 ? 1.0 / (1.0 - lambda)
                                            : (2.0 + std::sqrt(1.0 + 2.0 * lambda)) / (3.0 - 2.0 * lambda);
  return {z, 1 - std::pow(std::abs(z), 2 * std::numbers::pi / omega_dt)};
}

class FreeMode : public testing::TestWithParam<TimeScheme> {};

/// Reference numbers, section 1: at dt = 0.2 ms BDF1 damps a free 120 Hz mode by 37 % per period, BDF2 by 0.5
/// %.
TEST_P(FreeMode, LosesWhatTheSchemeTakes) {
  const auto scheme = GetParam();
  const double omega = 2 * std::numbers::pi * 120, dt = 2e-4;
  PhaseTimer timer;
  // The thickness at which the first mode of this mesh lies at 120 Hz.
  double h = 0.01, computed = 0;
  PlateProblem plate;
  VibrationMode mode;
  for (int iteration = 0; iteration < 5; ++iteration) {
    plate = ring_plate(timer, 0.0, 1.0, h, 0.49, 25, 0.0);
    mode = first_vibration(plate.disc, plate.operators);
    computed = mode.omega;
    if (iteration < 4) h *= omega / computed;
  }
  ASSERT_NEAR(computed, omega, 1e-6 * omega);
  const auto expected = numerical_damping(scheme, omega * dt);

  // History on the discrete mode d^n = Re(z^n) phi, x^n = Re(i omega z^n) phi, so that no start-up error
  // enters.
  State state = initial_state(plate.disc);
  state.step = 100;
  for (int level : {0, 1}) {
    const auto z = std::pow(expected.factor, -level);
    state.d[level] = z.real() * mode.shape;
    state.x[level] = (std::complex<double>(0, omega) * z).real() * mode.shape;
  }
  const auto energy = [&] {
    return 0.5 * state.x[0].dot(plate.operators.mass * state.x[0]) +
           0.5 * state.d[0].dot(plate.operators.stiffness * state.d[0]);
  };
  const double before = energy();
  TimeStepper<2> stepper(plate.disc, plate.operators, scheme, dt, 1, timer);
  constexpr int steps = 125, periods = 3; // 3 periods of 120 Hz are 125 steps of 0.2 ms
  for (int step = 0; step < steps; ++step) stepper.advance(state);
  const double loss = 1 - std::pow(energy() / before, 0.5 / periods);
  std::printf("%s at 120 Hz, 0.2 ms: loses %.3f %% of the amplitude per period, theory %.3f %%\n",
              scheme == TimeScheme::bdf1 ? "BDF1" : "BDF2", 100 * loss, 100 * expected.loss_per_period);
  EXPECT_NEAR(loss, expected.loss_per_period, 1e-3 * expected.loss_per_period);
  EXPECT_NEAR(loss, scheme == TimeScheme::bdf1 ? 0.37 : 0.005, scheme == TimeScheme::bdf1 ? 0.005 : 0.0005);
}

INSTANTIATE_TEST_SUITE_P(Schemes, FreeMode, testing::Values(TimeScheme::bdf1, TimeScheme::bdf2),
                         [](const auto& instance) {
                           return instance.param == TimeScheme::bdf1 ? "Bdf1" : "Bdf2";
                         });

} // namespace
} // namespace undula::verification
