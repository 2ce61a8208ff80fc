// Time stepping of the coupled system: orders of BDF1 and BDF2, and stability whatever the added mass.
#include <gtest/gtest.h>

#include <cstdio>

#include "fom/time/time_stepper.hpp"
#include "tests/verification/support/eigenmodes.hpp"
#include "tests/verification/support/names.hpp"
#include "tests/verification/support/wave_problem.hpp"

namespace undula::verification {
namespace {

constexpr double pi = std::numbers::pi;

/// (x, M x) + (d, K d), twice the energy.
double energy_product(const Operators<2>& operators, const Eigen::VectorXd& x, const Eigen::VectorXd& d) {
  return x.dot(operators.mass * x) + d.dot(operators.stiffness * d);
}

/// The energy that BDF2 never increases without loads (Dahlquist's G-norm).
double g_energy(const Operators<2>& operators, const State& state) {
  const Eigen::VectorXd x = 2 * state.x[0] - state.x[1], d = 2 * state.d[0] - state.d[1];
  return energy_product(operators, state.x[0], state.d[0]) + energy_product(operators, x, d);
}

struct WaveMarch {
  double error = 0;  ///< in the energy norm at the end, relative to the energy norm at the start
  double growth = 0; ///< largest relative increase of g_energy in one step (BDF2)
};

/// Marches a coupled eigenmode over one period from its exact history, against Re(x exp(s t)).
WaveMarch march_mode(const Discretisation<2>& disc, const Operators<2>& operators, const CoupledMode& mode,
                     TimeScheme scheme, int steps) {
  const double dt = 2 * pi / std::abs(mode.s.imag()) / steps;
  const auto exact_x = [&](int step) {
    return Eigen::VectorXd((mode.x * std::exp(mode.s * (step * dt))).real());
  };
  const auto exact_d = [&](int step) {
    Eigen::VectorXd d = (mode.x / mode.s * std::exp(mode.s * (step * dt))).real();
    d.head(disc.fluid_unknowns()).setZero();
    return d;
  };
  State state = initial_state(disc);
  state.step = 10; // past the start, which BDF2 makes with BDF1
  for (int level : {0, 1}) {
    state.x[level] = exact_x(-level);
    state.d[level] = exact_d(-level);
  }
  const double start = energy_product(operators, state.x[0], state.d[0]);
  PhaseTimer timer;
  TimeStepper<2> stepper(disc, operators, scheme, dt, 1000, timer);
  WaveMarch march;
  for (int step = 0; step < steps; ++step) {
    const double before = g_energy(operators, state);
    stepper.advance(state);
    march.growth = std::max(march.growth, g_energy(operators, state) / before - 1);
  }
  march.error =
      std::sqrt(energy_product(operators, state.x[0] - exact_x(steps), state.d[0] - exact_d(steps)) / start);
  return march;
}

/// A coarse wave problem; orders and stability are those of the semi-discrete system, so it need not be
/// resolved.
WaveCase coarse_wave(double solid_density) {
  return {{pi, 0.03, 1.686e7, 0.49, solid_density, 1.0, 0.1, {0.25, 0.25}}, 16, 13, 0.01};
}

class CoupledTimeOrder : public testing::TestWithParam<TimeScheme> {};

TEST_P(CoupledTimeOrder, IsThatOfTheScheme) {
  const auto scheme = GetParam();
  const int order = scheme == TimeScheme::bdf1 ? 1 : 2;
  const auto scene = coarse_wave(1.125);
  PhaseTimer timer;
  const auto disc = wave_discretisation(scene);
  const auto operators = build_operators(disc, PETSC_COMM_SELF, timer);
  const auto mode = coupled_mode(disc, operators, scene.wave.eigenvalue(), plate_cosine(disc, pi));
  double coarse = 0;
  for (const int steps : {100, 200, 400}) {
    const double fine = march_mode(disc, operators, mode, scheme, steps).error;
    std::printf("coupled wave, BDF%d, %d steps per period: error %.3e", order, steps, fine);
    if (coarse > 0) {
      std::printf(" (order %.2f)", std::log2(coarse / fine));
      EXPECT_NEAR(std::log2(coarse / fine), order, 0.15);
    }
    std::printf("\n");
    coarse = fine;
  }
}

/// Nonlinear and driven: a plate clamped to a moving holder in a channel with one opening, Navier-Stokes.
TEST_P(CoupledTimeOrder, HoldsWithConvectionAndImposedMotion) {
  const auto scheme = GetParam();
  const int order = scheme == TimeScheme::bdf1 ? 1 : 2;
  const double period = 0.02, stroke = 0.1;
  FsiProblem<2> problem;
  problem.fluid = {1.0, 0.035};
  problem.stabilisation = derived_weights(10.0, 0.001);
  problem.background = box({0, -0.2}, {1, 0.2}, 20, 11);
  using Kind = BoundaryCondition<2>::Kind;
  for (const char* name : {"left", "bottom", "top"}) problem.boundary[name].kind = Kind::velocity;
  problem.boundary["right"].kind = Kind::opening;
  SolidBody<2> plate;
  plate.mesh = box({0.1, -0.015}, {0.7, 0.015}, 20, 2);
  plate.properties = {1.125, 1.686e6, 0.49, 1e-4};
  plate.imposed = [](const Point<2>& x) { return x[0] < 0.13; };
  plate.imposed_displacement = [=](const Point<2>&, double t) {
    return Point<2>(0, stroke * std::pow(std::sin(pi * t / period), 4));
  };
  problem.solids.push_back(std::move(plate));
  const auto disc = discretise(std::move(problem), CutOptions{});
  PhaseTimer timer;
  const auto operators = build_operators(disc, PETSC_COMM_SELF, timer);
  std::vector<State> ends;
  for (const int steps : {48, 96, 192}) {
    State state = initial_state(disc);
    TimeStepper<2> stepper(disc, operators, scheme, 0.75 * period / steps, 1, timer);
    while (state.step < steps) stepper.advance(state);
    ends.push_back(std::move(state));
  }
  const auto difference = [&](const State& a, const State& b) {
    return std::sqrt(energy_product(operators, a.x[0] - b.x[0], a.d[0] - b.d[0]) /
                     energy_product(operators, b.x[0], b.d[0]));
  };
  const double coarse = difference(ends[0], ends[1]), fine = difference(ends[1], ends[2]);
  std::printf("driven plate with convection, BDF%d: differences %.3e, %.3e (order %.2f)\n", order, coarse,
              fine, std::log2(coarse / fine));
  EXPECT_NEAR(std::log2(coarse / fine), order, 0.2);
}

INSTANTIATE_TEST_SUITE_P(Schemes, CoupledTimeOrder, testing::Values(TimeScheme::bdf1, TimeScheme::bdf2),
                         [](const auto& instance) {
                           return instance.param == TimeScheme::bdf1 ? "Bdf1" : "Bdf2";
                         });

class AddedMass : public testing::TestWithParam<double> {};

/// A scheme that lagged the fluid's load would blow up at small densities of the solid.
TEST_P(AddedMass, NeverMakesTheMonolithicSystemUnstable) {
  const double ratio = GetParam();
  const auto scene = coarse_wave(ratio);
  PhaseTimer timer;
  const auto disc = wave_discretisation(scene);
  const auto operators = build_operators(disc, PETSC_COMM_SELF, timer);
  const auto mode = coupled_mode(disc, operators, scene.wave.eigenvalue(), plate_cosine(disc, pi));
  const auto march = march_mode(disc, operators, mode, TimeScheme::bdf2, 100);
  std::printf(
      "rho_s/rho_f = %g: s = %.2f + %.2fi 1/s, error after a period %.2f %%, energy growth per step %.1e\n",
      ratio, mode.s.real(), mode.s.imag(), 100 * march.error, march.growth);
  EXPECT_LT(march.growth, 1e-9);
  EXPECT_LT(march.error, 0.01);

  // From rest in a shape that is no mode: bounded, and damped by the fluid.
  State state = initial_state(disc);
  for (auto& d : state.d)
    d = plate_cosine(disc, 2 * pi) + 0.3 * plate_cosine(disc, 5 * pi) + plate_cosine(disc, pi);
  state.step = 10;
  TimeStepper<2> stepper(disc, operators, TimeScheme::bdf2, 1e-3, 1000, timer);
  const double start = g_energy(operators, state);
  for (int step = 0; step < 100; ++step) {
    const double before = g_energy(operators, state);
    stepper.advance(state);
    EXPECT_LE(g_energy(operators, state), before * (1 + 1e-9) + 1e-12 * start);
  }
  EXPECT_LT(g_energy(operators, state), 0.5 * start);
}

INSTANTIATE_TEST_SUITE_P(DensityRatios, AddedMass, testing::Values(1e-3, 1e-2, 0.1, 1.0, 10.0));

} // namespace
} // namespace undula::verification
