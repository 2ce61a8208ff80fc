// A bending wave that runs along a plate between two narrow gaps: complex wave number against the dispersion
// relation of an inviscid fluid between rigid walls.
#include <gtest/gtest.h>

#include <complex>
#include <cstdio>
#include <numbers>

#include "fom/levels/march.hpp"
#include "fom/levels/thin_gap_level.hpp"
#include "fom/scene/scene_time.hpp"
#include "tests/verification/support/names.hpp"
#include "tests/verification/support/thin_gap_scene.hpp"

namespace undula::verification {
namespace {

using Complex = std::complex<double>;

/// Plate in a fluid, cgs.
struct WaveCase {
  const char* name;
  double h, upper, lower, young, poisson, solid_density, fluid_density, damping_time, omega;

  /// D (1 + i w tau) k^4 - w^2 (rho_s h + sum rho / (k tanh kH)) = 0 by the secant method from `k`: the root
  /// that decays along the direction in which the wave runs, k = k_r - i k_i for exp(i (w t - k x)).
  Complex wave_number(double density) const {
    const Complex stiff =
        young * h * h * h / (12 * (1 - poisson * poisson)) * Complex(1, omega * damping_time);
    const auto residual = [&](Complex k) {
      Complex mass = solid_density * h;
      for (const double H : {upper, lower})
        if (density > 0) mass += density / (k * std::tanh(k * H));
      return stiff * std::pow(k, 4) / (omega * omega * mass) - 1.0;
    };
    // Long waves: k^6 or k^4 in closed form.
    const double inverse = 1 / upper + 1 / lower;
    Complex k = density > 0 ? std::pow(omega * omega * density * inverse / stiff, 1.0 / 6)
                            : std::pow(omega * omega * solid_density * h / stiff, 0.25);
    Complex before = k * Complex(1.01, 0.001), at_before = residual(before);
    for (int i = 0; i < 60; ++i) {
      const Complex at = residual(k), step = at * (k - before) / (at - at_before);
      before = k;
      at_before = at;
      k -= step;
      if (std::abs(step) < 1e-13 * std::abs(k)) break;
    }
    return k;
  }
};

/// Marches a long plate whose far end oscillates until it is periodic, and fits exp(-i k x) to the complex
/// amplitude of the deflection, x being the distance from the moved end.
Complex measured_wave_number(const WaveCase& wave) {
  constexpr int steps = 160, periods = 9;
  constexpr double wave_lengths = 8, inner = 1e4; // cm: plane
  const double length = wave_lengths * 2 * std::numbers::pi / wave.wave_number(wave.fluid_density).real();
  constexpr int cells = 400;
  Scene scene;
  scene.space = Space::thin_gap;
  scene.coupling = Coupling::implicit;
  scene.flow = FlowModel::stokes;
  scene.fluid = {wave.fluid_density, 1e-9};
  scene.membrane = {wave.solid_density, wave.young, wave.poisson, wave.damping_time};
  scene.operating_point = {wave.omega / (2 * std::numbers::pi), 1e-6 * wave.upper, 0.0, 1.0};
  scene.time.steps_per_period = steps;
  scene.time.periods = periods;
  scene.time.ramp_periods = 2;
  scene.thin_gap.film_thickness = 1e-6 * wave.upper;
  scene.thin_gap.momentum_factor = 1;
  scene.thin_gap.newton_tolerance = 1e-6;
  const ThinGapModel model{
      even_layout(inner, inner + length, cells, cells - 2, cells - 1, wave.h, wave.upper, wave.lower)};
  State state = initial_state(model);
  PhaseTimer timer;
  const auto probes = membrane_probes(model, cells + 1);
  Eigen::VectorXcd amplitude = Eigen::VectorXcd::Zero(cells + 1);
  ThinGapLevel level(model);
  march(level, scene, state, timer, [&](const State& now, const Observation&) {
    if (now.step <= (periods - 1) * steps) return;
    amplitude += Eigen::VectorXd(probes.axial * now.d[0]).cast<Complex>() *
                 std::exp(Complex(0, -wave.omega * now.time)) * (2.0 / steps);
  });
  // ln(amplitude) = const - i k x over the middle, phases made continuous; least squares.
  const double from = 1.5 / wave_lengths * length, to = 4.5 / wave_lengths * length;
  std::vector<double> x;
  std::vector<Complex> log;
  for (int i = cells; i >= 0; --i) {
    const double s = inner + length - probes.radius[i];
    if (s < from || s > to) continue;
    Complex value = std::log(amplitude[i]);
    while (!log.empty() && value.imag() - log.back().imag() > std::numbers::pi)
      value -= Complex(0, 2 * std::numbers::pi);
    x.push_back(s);
    log.push_back(value);
  }
  double mean_x = 0;
  Complex mean = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i] / static_cast<double>(x.size());
    mean += log[i] / static_cast<double>(x.size());
  }
  Complex product = 0;
  double square = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    product += (x[i] - mean_x) * (log[i] - mean);
    square += (x[i] - mean_x) * (x[i] - mean_x);
  }
  return product / square * Complex(0, 1);
}

class ThinGapWave : public testing::TestWithParam<WaveCase> {};

TEST_P(ThinGapWave, FollowsTheDispersionRelation) {
  const auto& wave = GetParam();
  const Complex k = measured_wave_number(wave), exact = wave.wave_number(wave.fluid_density);
  const Complex dry = wave.wave_number(0);
  std::printf(
      "gaps %.3f, %.3f cm, density %.2f: k %.5f %+.5fi 1/cm, exact %.5f %+.5fi: real %+.3f %%, "
      "imaginary %+.3f %%; kH %.3f, kh %.3f; without the fluid %.5f %+.5fi\n",
      wave.upper, wave.lower, wave.fluid_density, k.real(), k.imag(), exact.real(), exact.imag(),
      100 * (k.real() / exact.real() - 1), 100 * (k.imag() / exact.imag() - 1),
      exact.real() * std::max(wave.upper, wave.lower), exact.real() * wave.h, dry.real(), dry.imag());
  EXPECT_NEAR(k.real(), exact.real(), 0.005 * exact.real());
  EXPECT_NEAR(k.imag(), exact.imag(), 0.005 * std::abs(exact.imag()));
  EXPECT_GT(std::abs(k - dry), 0.5 * std::abs(dry)); // the relation sees the fluid
}

INSTANTIATE_TEST_SUITE_P(
    Gaps, ThinGapWave,
    testing::Values(WaveCase{"Equal", 0.02, 0.04, 0.04, 1.686e7, 0.49, 1.125, 1.0, 0.12, 8.5},
                    WaveCase{"Unequal", 0.02, 0.02, 0.05, 1.686e7, 0.49, 1.125, 1.0, 0.12, 8.5}),
    [](const auto& instance) { return std::string(instance.param.name); });

} // namespace
} // namespace undula::verification
