// A holder driven by a voltage, in finite elements: alone, and with the added mass of a fluid that it moves.
#include <gtest/gtest.h>

#include <complex>
#include <cstdio>
#include <numbers>

#include "fom/problem/default_weights.hpp"
#include "fom/time/time_stepper.hpp"
#include "tests/verification/support/names.hpp"
#include "tests/verification/support/solid_meshes.hpp"

namespace undula::verification {
namespace {

using Complex = std::complex<double>;
constexpr double pi = std::numbers::pi;

constexpr double frequency = 10, omega = 2 * pi * frequency; // 1/s
constexpr double mass = 2, damping = 20, stiffness = 4e3;    // g, dyn s/cm, dyn/cm
constexpr double force = 5e3;                                // dyn

DrivenHolder holder() {
  DrivenHolder driven;
  driven.actuator.force_per_volt = force;
  driven.actuator.moving_mass = mass;
  driven.actuator.damping = damping;
  driven.actuator.stiffness = stiffness;
  driven.voltage = [](double t) { return std::sin(omega * t); };
  return driven;
}

/// Displacement of the holder after every step from rest, cm.
std::vector<double> march(FsiProblem<2> problem, int steps_per_period, int periods, double gravity = 0) {
  problem.holder = holder();
  problem.holder->actuator.gravity = gravity;
  PhaseTimer timer;
  const auto disc = discretise(std::move(problem), CutOptions{});
  const auto operators = build_operators(disc, MPI_COMM_SELF, timer);
  TimeStepper<2> stepper(disc, operators, TimeScheme::bdf2, 1 / (frequency * steps_per_period),
                         steps_per_period, timer);
  State state = initial_state(disc);
  std::vector<double> place;
  for (int step = 0; step < periods * steps_per_period; ++step) {
    stepper.advance(state);
    place.push_back(state.d[0][disc.joined.front()]);
  }
  return place;
}

/// Coefficient of the last period's fundamental: the motion is the imaginary part of it times exp(i omega t).
Complex fundamental(const std::vector<double>& place, int steps) {
  Complex sum = 0;
  for (std::size_t i = place.size() - static_cast<std::size_t>(steps); i < place.size(); ++i)
    sum += place[i] * std::exp(Complex(0, -omega * static_cast<double>(i + 1) / (frequency * steps)));
  return Complex(0, 2) * sum / static_cast<double>(steps);
}

/// What BDF2 makes of i omega.
Complex symbol(int steps) {
  const Complex z = std::exp(Complex(0, -2 * pi / steps));
  return (1.5 - 2.0 * z + 0.5 * z * z) * frequency * static_cast<double>(steps);
}

/// Of an oscillator with the impedance m s + c + k / s and more, at i omega or what the scheme makes of it.
Complex oscillator(Complex s, double m, Complex more = 0) {
  return force / (m * s * s + damping * s + stiffness + s * more);
}

SolidBody<2> rigid_block(Point<2> low, Point<2> high, double density) {
  SolidBody<2> block;
  block.mesh = box(low, high, 4, 2);
  block.properties = {density, 1e6, 0.3, 0};
  block.imposed = [](const Point<2>&) { return true; };
  return block;
}

// The body's own inertia counts once, beside the moving mass.
TEST(DrivenHolder, AloneSwingsAsTheOscillator) {
  const double body = 3.0 * 0.5 * 0.25;
  double last = 0, last_transient = 0;
  for (const int steps : {48, 96}) {
    const auto place = march(in_vacuo(Space::plane, rigid_block({0, 0}, {0.5, 0.25}, 3.0)), steps, 60);
    const Complex found = fundamental(place, steps);
    const double scheme = std::abs(found / oscillator(symbol(steps), mass + body) - 1.0);
    const double error = std::abs(found / oscillator(Complex(0, omega), mass + body) - 1.0);
    // From rest: the steady swing and the free one that cancels it at t = 0.
    const Complex steady = oscillator(Complex(0, omega), mass + body);
    const double decay = damping / (2 * (mass + body)),
                 free = std::sqrt(stiffness / (mass + body) - decay * decay);
    const double at_zero = steady.imag(), rate = (Complex(0, omega) * steady).imag();
    double transient = 0;
    for (int i = 0; i < 3 * steps; ++i) {
      const double t = (i + 1) / (frequency * steps);
      const double exact = (steady * std::exp(Complex(0, omega * t))).imag() -
                           std::exp(-decay * t) * (at_zero * std::cos(free * t) +
                                                   (rate + decay * at_zero) / free * std::sin(free * t));
      transient = std::max(transient, std::abs(place[static_cast<std::size_t>(i)] - exact));
    }
    transient /= std::abs(steady);
    std::printf(
        "holder alone, %d steps: off the scheme's answer by %.1e, off the exact one by %.2e, in the first "
        "periods by %.2e\n",
        steps, scheme, error, transient);
    EXPECT_LT(scheme, 1e-8);
    if (last > 0) {
      EXPECT_NEAR(std::log2(last / error), 2, 0.15);
      EXPECT_NEAR(std::log2(last_transient / transient), 2, 0.25);
    }
    last = error;
    last_transient = transient;
  }
}

// The weight of the moving mass, and of it alone, moves the place about which it swings.
TEST(DrivenHolder, HangsByItsWeight) {
  const int steps = 48;
  const auto place = march(in_vacuo(Space::plane, rigid_block({0, 0}, {0.5, 0.25}, 3.0)), steps, 60, -981);
  double mean = 0;
  for (std::size_t i = place.size() - steps; i < place.size(); ++i) mean += place[i] / steps;
  EXPECT_NEAR(mean, -981 * mass / stiffness, 1e-6);
}

// A piston between two columns of fluid in a frictionless tube moves them with it, exactly.
TEST(DrivenHolder, CarriesAColumnOfFluid) {
  const double height = 1, low = 0.437, high = 0.551, width = 0.5;
  FsiProblem<2> problem;
  problem.flow = FlowModel::stokes;
  problem.fluid = {1.0, 0.05};
  problem.stabilisation = derived_weights(1.0, 0.1);
  problem.background =
      tensor_mesh(spaced(0, width, 5), spaced(0, height, 16), {"left", "right", "below", "above"});
  using Kind = BoundaryCondition<2>::Kind;
  problem.boundary["left"].kind = problem.boundary["right"].kind = Kind::symmetry;
  problem.boundary["below"].kind = problem.boundary["above"].kind = Kind::opening;
  problem.solids.push_back(rigid_block({0, low}, {width, high}, 0));
  const int steps = 64;
  const Complex found = fundamental(march(std::move(problem), steps, 40), steps);
  const double column = width * (height - (high - low));
  const double error = std::abs(found / oscillator(symbol(steps), mass + column) - 1.0);
  const double without = std::abs(found / oscillator(symbol(steps), mass) - 1.0);
  std::printf("holder with %.3f g of fluid: off by %.1e, %.2f without it\n", column, error, without);
  EXPECT_LT(error, 1e-6);
  EXPECT_GT(without, 0.1);
}

/// A plate between two layers of fluid, open at x = length: the pressure of lubrication theory with inertia.
/// With u the mean velocity, rho s u / (1 - tanh(q) / q) = -dp/dx, q = (h / 2) sqrt(s / nu).
Complex layers_impedance(Complex s, double density, double viscosity, double gap, double length) {
  const Complex q = 0.5 * gap * std::sqrt(s * density / viscosity);
  return 2.0 * density * s / (1.0 - std::tanh(q) / q) * length * length * length / (3 * gap);
}

TEST(DrivenHolder, SqueezesALayerWithItsAddedMass) {
  const double length = 1, gap = 0.05, plate = 0.05, density = 1, viscosity = 0.035;
  double last = 0;
  for (const int across : {4, 8}) {
    FsiProblem<2> problem;
    problem.flow = FlowModel::stokes;
    problem.fluid = {density, viscosity};
    problem.stabilisation = derived_weights(1.0, 0.01);
    // The plate's faces lie within cells.
    const int cells = across * 3;
    problem.background = tensor_mesh(spaced(0, length, 4 * across), spaced(0, 2 * gap + plate, cells + 1),
                                     {"middle", "end", "below", "above"});
    using Kind = BoundaryCondition<2>::Kind;
    problem.boundary["middle"].kind = Kind::symmetry;
    problem.boundary["end"].kind = Kind::opening;
    problem.boundary["below"].kind = problem.boundary["above"].kind = Kind::velocity;
    problem.solids.push_back(rigid_block({0, gap}, {length, gap + plate}, 0));
    const int steps = 64;
    const Complex found = fundamental(march(std::move(problem), steps, 20), steps);
    const Complex s = symbol(steps);
    const Complex layers = layers_impedance(s, density, viscosity, gap, length);
    const double error = std::abs(found / oscillator(s, mass, layers) - 1.0);
    const double heavy = layers.imag() / omega;
    std::printf("holder on two layers, %d cells across: off by %.2e; they add %.2f g and %.0f dyn s/cm\n",
                across, error, heavy, layers.real());
    EXPECT_LT(error, across == 4 ? 0.05 : 0.015);
    if (last > 0) {
      EXPECT_GT(std::log2(last / error), 1.5);
    }
    last = error;
    EXPECT_GT(heavy, 5 * mass);
  }
}

} // namespace
} // namespace undula::verification
