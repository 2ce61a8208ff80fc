// Flows with exact solutions in a pipe and a channel: Poiseuille, and Womersley's oscillating flow.
#include <gtest/gtest.h>

#include <complex>
#include <cstdio>
#include <numbers>

#include "fom/problem/default_weights.hpp"
#include "fom/time/steady.hpp"
#include "fom/time/time_stepper.hpp"
#include "tests/verification/support/names.hpp"
#include "tests/verification/support/rectangle_mesh.hpp"

namespace undula::verification {
namespace {

using Complex = std::complex<double>;
constexpr double pi = std::numbers::pi;

/// A straight duct of width 1 and the given length along y, flow from "bottom" to "top"; x = 1 is the wall, x
/// = 0 the axis of a pipe (radius 1) or the other wall of a channel.
FsiProblem<2> duct(Space space, int cells_across, double length, double density, double viscosity,
                   const TimeFunction& pressure_drop, const StabilisationWeights& weights) {
  using Kind = BoundaryCondition<2>::Kind;
  FsiProblem<2> problem;
  problem.space = space;
  problem.fluid = {density, viscosity};
  problem.stabilisation = weights;
  problem.background = tensor_mesh(spaced(0, 1, cells_across), spaced(0, length, 4));
  problem.boundary["left"].kind = space == Space::axisymmetric ? Kind::symmetry : Kind::velocity;
  problem.boundary["right"].kind = Kind::velocity;
  for (const char* name : {"bottom", "top"}) {
    problem.boundary[name].kind = Kind::opening;
    problem.boundary[name].opening = OpeningCondition::traction;
  }
  problem.boundary["bottom"].pressure = pressure_drop;
  return problem;
}

double steady_flow(const FsiProblem<2>& problem) {
  PhaseTimer timer;
  const auto disc = discretise<2>(problem, {});
  const auto operators = build_operators<2>(disc, MPI_COMM_SELF, timer);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(disc.unknowns());
  solve_steady<2>(disc, operators, 1e-10, 30, timer, x);
  const double out = operators.openings.at("top").dot(x), in = -operators.openings.at("bottom").dot(x);
  EXPECT_NEAR(in, out, 1e-9 * std::abs(out));
  return out;
}

TEST(FluidPipe, PoiseuilleFlowOfPipeAndChannel) {
  const double viscosity = 0.04, drop = 0.3, length = 0.5;
  const auto weights = derived_weights(1.0, 0.1);
  for (const auto space : {Space::axisymmetric, Space::plane}) {
    const double exact = space == Space::axisymmetric ? pi * drop / (8 * viscosity * length)
                                                      : drop / (12 * viscosity * length);
    const auto problem = duct(
        space, 40, length, 1.06, viscosity, [=](double) { return drop; }, weights);
    const double error = steady_flow(problem) / exact - 1;
    std::printf("Poiseuille, %s: flow %+.3f %%\n", space == Space::axisymmetric ? "pipe" : "channel",
                100 * error);
    EXPECT_LT(std::abs(error), 0.005);
  }
}

/// Bessel functions of the first kind, order 0 and 1, by their power series; 16 digits lose |exp(|z|)|.
Complex bessel(int order, Complex z) {
  Complex term = order == 0 ? Complex(1) : 0.5 * z, sum = term;
  for (int k = 1; k < 80; ++k) {
    term *= -0.25 * z * z / (static_cast<double>(k) * (k + order));
    sum += term;
  }
  return sum;
}

TEST(FluidPipe, BesselSeries) {
  EXPECT_NEAR(bessel(0, 2.404825557695773).real(), 0, 1e-15); // first zeros of J0 and J1
  EXPECT_NEAR(bessel(1, 3.831705970207512).real(), 0, 1e-15);
  EXPECT_NEAR(bessel(0, Complex(0, 1)).real(), 1.2660658777520084, 1e-15); // I0(1)
}

/// Womersley's flow under the pressure gradient gradient cos(omega t) in a pipe of radius 1.
struct Womersley {
  double density, omega, gradient, alpha;
  Complex wave() const { return alpha * std::pow(Complex(0, 1), 1.5); }
  Complex scale() const { return gradient / (Complex(0, 1) * omega * density); }
  /// Flow = Re(amplitude exp(i omega t)).
  Complex flow_amplitude() const {
    const Complex z = wave();
    return pi * scale() * (1.0 - 2.0 * bessel(1, z) / (z * bessel(0, z)));
  }
  double velocity(double r, double t) const {
    const Complex z = wave();
    return std::real(scale() * (1.0 - bessel(0, z * r) / bessel(0, z)) * std::exp(Complex(0, omega * t)));
  }
};

/// First harmonic of the outflow over the second of two periods, from the exact flow at the first two time
/// levels.
Complex computed_amplitude(const Womersley& exact, int cells_across, int steps_per_period,
                           TimeScheme scheme) {
  const double length = 0.5, period = 2 * pi / exact.omega, dt = period / steps_per_period;
  const double viscosity = exact.density * exact.omega / (exact.alpha * exact.alpha);
  PhaseTimer timer;
  const auto disc =
      discretise<2>(duct(
                        Space::axisymmetric, cells_across, length, exact.density, viscosity,
                        [&](double t) { return exact.gradient * length * std::cos(exact.omega * t); },
                        derived_weights(std::abs(exact.scale()), dt)),
                    {});
  const auto operators = build_operators<2>(disc, MPI_COMM_SELF, timer);
  TimeStepper<2> stepper(disc, operators, scheme, dt, 1, timer);
  auto state = initial_state(disc);
  state.step = 1;
  for (int level = 0; level < 2; ++level)
    for (std::size_t node = 0; node < disc.fluid_nodes.dof_point.size(); ++node) {
      const double r = disc.cut.mesh.points[disc.fluid_nodes.dof_point[node]][0];
      state.x[level][disc.velocity_unknown(static_cast<int>(node), 1)] = exact.velocity(r, (1 - level) * dt);
    }
  Complex amplitude = 0;
  while (state.step < 2 * steps_per_period) {
    stepper.advance(state);
    if (state.step > steps_per_period)
      amplitude +=
          operators.openings.at("top").dot(state.x[0]) * std::exp(Complex(0, -exact.omega * state.time));
  }
  return 2.0 / steps_per_period * amplitude;
}

TEST(FluidPipe, WomersleyFlow) {
  for (const double alpha : {3.0, 10.0}) {
    const Womersley exact{1.06, 2 * pi, 6.0, alpha};
    const Complex error = computed_amplitude(exact, 40, 120, TimeScheme::bdf2) / exact.flow_amplitude();
    std::printf("Womersley, alpha = %4.1f: amplitude %+.3f %%, phase %+.3f degrees\n", alpha,
                100 * (std::abs(error) - 1), std::arg(error) * 180 / pi);
    EXPECT_LT(std::abs(std::abs(error) - 1), 0.005);
    EXPECT_LT(std::abs(std::arg(error)), 0.005);
  }
}

} // namespace
} // namespace undula::verification
