// The holder driven by a voltage: alone, where its motion is known, and on the pump.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstdio>
#include <numbers>

#include "fom/levels/marched_curve.hpp"
#include "fom/levels/thin_gap_level.hpp"
#include "tests/verification/support/thin_gap_scene.hpp"

namespace undula::verification {
namespace {

using Complex = std::complex<double>;
using Settings = std::vector<std::string>;

struct DrivenRun {
  CurvePoint point;
  std::vector<Observation> steps;
};

DrivenRun run(Settings settings, const Settings& more = {}) {
  settings.insert(settings.end(), more.begin(), more.end());
  const Scene scene = thin_gap_scene(settings);
  PhaseTimer timer;
  ThinGapLevel level(scene, timer);
  State state = level.initial_state();
  DrivenRun result;
  const PeriodicRun marched = march_until_periodic(
      level, scene, state, [&](const State&, const Observation& seen) { result.steps.push_back(seen); });
  result.point = curve_point(marched, 50);
  return result;
}

const Settings by_voltage = {"operating_point.drive=voltage", "operating_point.voltage_V=40"};

/// A holder so heavy, in a fluid so thin, that nothing else resists it: mass 5 kg, near its resonance.
Settings heavy_holder() {
  Settings settings = by_voltage;
  settings.insert(
      settings.end(),
      {"actuator.force_N_per_V=2", "actuator.moving_mass_g=5000", "actuator.suspension_N_per_mm=3000",
       "actuator.damping_N_s_per_m=1000", "fluid.density_g_per_cm3=1e-6", "fluid.viscosity_poise=1e-8",
       "operating_point.head_mmHg=0", "time.periods=40", "training.periodic_tolerance=1e-6",
       "membrane.young_dyn_per_cm2=1e5", "membrane.density_g_per_cm3=1e-3"});
  return settings;
}

/// Displacement (mm) of mass, damping and spring under a force (N), where time steps make s of i omega.
Complex oscillator(Complex s, double force) { return 1e3 * force / (3000e3 + 1000.0 * s + 5.0 * s * s); }

Complex holder_of(const CurvePoint& point) {
  return std::polar(point.stroke_mm, -point.phase_degrees * std::numbers::pi / 180);
}

// The scheme makes of d/dt at exp(i omega t) the symbol (3/2 - 2 z + z^2 / 2) / dt, z = exp(-i omega dt):
// against it the motion is exact, and the symbol is i omega to second order.
TEST(VoltageDrive, HolderAloneSwingsAsTheOscillator) {
  const double omega = 2 * std::numbers::pi * 120;
  double last_error = 0;
  for (const int steps : {48, 96}) {
    const auto result = run(heavy_holder(), {"time.steps_per_period=" + std::to_string(steps)});
    const double dt = 1 / (120.0 * steps);
    const Complex z = std::exp(Complex(0, -omega * dt));
    const Complex discrete = oscillator((1.5 - 2.0 * z + 0.5 * z * z) / dt, 80);
    const Complex exact = oscillator(Complex(0, omega), 80), found = holder_of(result.point);
    const double error = std::abs(found / exact - 1.0);
    std::printf(
        "holder alone, %d steps: %.5f mm, phase %.3f degrees; off the scheme's own answer by %.1e, off the "
        "exact one by %.2e\n",
        steps, result.point.stroke_mm, result.point.phase_degrees, std::abs(found / discrete - 1.0), error);
    EXPECT_LT(std::abs(found / discrete - 1.0), 1e-5); // what is left of membrane and fluid
    if (last_error > 0) {
      EXPECT_NEAR(std::log2(last_error / error), 2, 0.15);
    }
    last_error = error;
  }
}

// A spring against which the pump is soft, and the force that bends it by the stroke.
TEST(VoltageDrive, OnAStiffSuspensionIsThatOfTheStroke) {
  Settings stiff = by_voltage;
  stiff.insert(stiff.end(), {"actuator.force_N_per_V=1325", "actuator.suspension_N_per_mm=1e5"});
  const auto voltage = run(stiff), stroke = run({});
  std::printf("stiff suspension: stroke %.5f mm (0.53), flow %.4f and %.4f l/min\n", voltage.point.stroke_mm,
              voltage.point.flow_l_per_min, stroke.point.flow_l_per_min);
  EXPECT_NEAR(voltage.point.stroke_mm, 0.53, 5e-4);
  EXPECT_NEAR(voltage.point.flow_l_per_min, stroke.point.flow_l_per_min, 0.02);
  EXPECT_NEAR(stroke.point.stroke_mm, 0.53, 1e-6);
  EXPECT_NEAR(voltage.point.reaction_quadrature_N_per_mm, stroke.point.reaction_quadrature_N_per_mm, 0.2);
}

Settings pump_by_voltage() {
  Settings settings = by_voltage;
  settings.insert(settings.end(), {"actuator.force_N_per_V=0.4", "actuator.moving_mass_g=9.65",
                                   "actuator.suspension_N_per_mm=20", "actuator.damping_N_s_per_m=1",
                                   "actuator.coil_resistance_ohm=10"});
  return settings;
}

// What the coil puts in is what damping takes and the holder gives to membrane and fluid; what the mains put
// in, besides, what the resistance takes.
TEST(VoltageDrive, PowersBalance) {
  const auto result = run(pump_by_voltage());
  double actuator = 0, holder = 0, damping = 0, electrical = 0, heat = 0;
  for (std::size_t i = result.steps.size() - 72; i < result.steps.size(); ++i) {
    const auto& seen = result.steps[i].holder;
    const double newton = seen.actuator_force * 1e-5;
    actuator += seen.actuator_power / 72;
    holder += result.steps[i].energy.holder / 72;
    damping += 1e3 * seen.velocity * seen.velocity / 72;
    electrical += seen.electrical_power / 72;
    heat += 1e7 * 10 * std::pow(newton / (0.4 * 10), 2) / 72; // R i^2, i = F / B, B = g R
  }
  std::printf(
      "powers: coil %.1f mW, holder %.1f + damping %.1f (%+.3f %%); mains %.1f, heat %.1f (%+.3f %%)\n",
      1e-4 * actuator, 1e-4 * holder, 1e-4 * damping, 100 * ((holder + damping) / actuator - 1),
      1e-4 * electrical, 1e-4 * heat, 100 * ((actuator + heat) / electrical - 1));
  EXPECT_NEAR((holder + damping) / actuator, 1, 1e-3);
  EXPECT_NEAR((actuator + heat) / electrical, 1, 1e-3);
  EXPECT_GT(actuator, 1e7); // more than a watt
}

// Offset, fundamental and two harmonics are all of the motion; stops bring the third harmonic.
TEST(VoltageDrive, HarmonicsMakeUpTheMotion) {
  const auto compare = [](const Settings& more) {
    const auto result = run(pump_by_voltage(), more);
    const CurvePoint& point = result.point;
    const int counted = 72 * point.averaged_periods;
    const auto part = [&](double amplitude, double phase_degrees, int n, double time) { // of the motion, mm
      return amplitude *
             std::sin(2 * std::numbers::pi * 120 * n * time - phase_degrees * std::numbers::pi / 180);
    };
    double mean = 0, square = 0, greatest_left = 0;
    for (auto step = result.steps.end() - counted; step != result.steps.end(); ++step) {
      const double place = 10 * step->holder.displacement; // mm
      mean += place / counted;
      square += place * place / counted;
      const double told_here = point.offset_mm + part(point.stroke_mm, point.phase_degrees, 1, step->time) +
                               part(point.stroke_2f_mm, point.phase_2f_degrees, 2, step->time) +
                               part(point.stroke_3f_mm, point.phase_3f_degrees, 3, step->time);
      greatest_left = std::max(greatest_left, std::abs(place - told_here));
    }
    const double variance = square - mean * mean;
    const double told = 0.5 * (std::pow(point.stroke_mm, 2) + std::pow(point.stroke_2f_mm, 2) +
                               std::pow(point.stroke_3f_mm, 2));
    std::printf("stroke %.4f mm, at 2 f %.4f, at 3 f %.4f: %.4f %% of the motion is beyond them\n",
                point.stroke_mm, point.stroke_2f_mm, point.stroke_3f_mm, 100 * (1 - told / variance));
    EXPECT_NEAR(told / variance, 1, 1e-3);
    // Amplitudes and phases put together are the motion itself.
    EXPECT_LT(greatest_left, 0.06 * point.stroke_mm);
    EXPECT_NEAR(point.offset_mm, mean, 1e-12);
    return point;
  };
  const CurvePoint free = compare({}),
                   stopped = compare({"actuator.stop_mm=0.3", "actuator.stop_N_per_mm=200"});
  EXPECT_GT(free.stroke_2f_mm, 1e-4);
  EXPECT_GT(stopped.stroke_3f_mm / stopped.stroke_mm, 3 * free.stroke_3f_mm / free.stroke_mm);
}

// The reaction of membrane and fluid, as it is measured, and the law of the oscillator give the stroke.
TEST(VoltageDrive, StrokeIsThatOfTheMeasuredReaction) {
  const auto result = run(pump_by_voltage());
  const CurvePoint& point = result.point;
  const double omega = 2 * std::numbers::pi * 120, electric = 0.4 * 0.4 * 10;
  const Complex resists(20 - 9.65e-6 * omega * omega + point.reaction_in_phase_N_per_mm,
                        1e-3 * omega * (1 + electric) + point.reaction_quadrature_N_per_mm);
  std::printf("stroke %.4f mm, by its reaction %.4f\n", point.stroke_mm, 0.4 * 40 / std::abs(resists));
  EXPECT_NEAR(point.stroke_mm, 0.4 * 40 / std::abs(resists), 0.005 * point.stroke_mm);
}

// The head pushes the holder aside, and an end stop keeps it.
TEST(VoltageDrive, StopsHoldTheHolder) {
  const auto greatest = [](const Settings& more) {
    double place = 0;
    for (const auto& seen : run(pump_by_voltage(), more).steps)
      place = std::max(place, std::abs(seen.holder.displacement));
    return 10 * place; // mm
  };
  const double free = greatest({}),
               stopped = greatest({"actuator.stop_mm=0.3", "actuator.stop_N_per_mm=1000"});
  std::printf("greatest displacement %.3f mm, with stops at 0.3 mm %.3f\n", free, stopped);
  EXPECT_GT(free, 0.45);
  EXPECT_LT(stopped, 0.35);
  EXPECT_GT(stopped, 0.3);
}

} // namespace
} // namespace undula::verification
