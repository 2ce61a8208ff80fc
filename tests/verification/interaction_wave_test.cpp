// Small membrane wave between two rigid walls: eigenvalue of the monolithic system against the dispersion
// relation with the added mass of two confined, viscous layers.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/verification/support/eigenmodes.hpp"
#include "tests/verification/support/wave_problem.hpp"

namespace undula::verification {
namespace {

constexpr double pi = std::numbers::pi;

/// The pump's membrane and fluid, the viscosity such that the Stokes layer (0.05 cm) spans a few elements.
MembraneWave pump_like_wave(double below, double above) {
  return {pi, 0.03, 1.686e7, 0.49, 1.125, 1.0, 0.1, {below, above}};
}

TEST(MembraneWaveTheory, TendsToPotentialFlowAndToThePlateAlone) {
  auto wave = pump_like_wave(0.25, 0.4);
  wave.viscosity = 1e-7;
  const auto s = wave.eigenvalue();
  EXPECT_NEAR(s.imag(), wave.inviscid_omega(), 1e-3 * s.imag());
  EXPECT_LT(s.real(), 0);
  EXPECT_GT(s.real(), -1e-2 * s.imag());
  wave.fluid_density = 1e-9;
  wave.viscosity = 1e-12;
  const double stiffness = 1.686e7 * 2.7e-5 / (12 * (1 - 0.49 * 0.49));
  EXPECT_NEAR(wave.eigenvalue().imag(), pi * pi * std::sqrt(stiffness / (1.125 * 0.03)),
              6e-3 * wave.eigenvalue().imag());
}

struct Layers {
  const char* name;
  double below, above;
};

class MembraneWaveTest : public testing::TestWithParam<Layers> {};

TEST_P(MembraneWaveTest, HasTheFrequencyAndDecayOfTheDispersionRelation) {
  const auto [name, below, above] = GetParam();
  WaveCase scene{pump_like_wave(below, above), 24, 37, 0.01};
  const auto exact = scene.wave.eigenvalue();
  auto one_layer = scene.wave, vacuo = scene.wave;
  one_layer.layers.pop_back();
  vacuo.layers.clear();

  PhaseTimer timer;
  const auto disc = wave_discretisation(scene);
  const auto operators = build_operators(disc, PETSC_COMM_SELF, timer);
  const auto mode =
      coupled_mode(disc, operators, exact * std::complex<double>(1.05, 0.1), plate_cosine(disc, pi));
  const double frequency_error = mode.s.imag() / exact.imag() - 1,
               decay_error = mode.s.real() / exact.real() - 1;
  std::printf(
      "wave, layers %.2f and %.2f cm: s = %.3f + %.3fi 1/s, exact %.3f + %.3fi (frequency %+.2f %%, decay "
      "%+.2f %%); inviscid %.2f, one layer %.2f, without fluid %.2f rad/s\n",
      below, above, mode.s.real(), mode.s.imag(), exact.real(), exact.imag(), 100 * frequency_error,
      100 * decay_error, scene.wave.inviscid_omega(), one_layer.eigenvalue().imag(), vacuo.inviscid_omega());
  EXPECT_LT(std::abs(frequency_error), 0.01);
  EXPECT_LT(std::abs(decay_error), 0.03);
  // What is tested: neither the plate alone, nor one layer, nor the fluid's mass without viscosity would
  // pass.
  EXPECT_GT(std::abs(vacuo.inviscid_omega() / exact.imag() - 1), 0.5);
  EXPECT_GT(std::abs(one_layer.eigenvalue().imag() / exact.imag() - 1), 0.2);
  EXPECT_GT(std::abs(scene.wave.inviscid_omega() / exact.imag() - 1), 0.05);
}

INSTANTIATE_TEST_SUITE_P(Layers, MembraneWaveTest,
                         testing::Values(Layers{"equal", 0.25, 0.25}, Layers{"unequal", 0.2, 0.35}),
                         [](const auto& instance) { return std::string(instance.param.name); });

} // namespace
} // namespace undula::verification
