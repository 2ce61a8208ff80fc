// Flows that a scene file states, against published values.
#include <cmath>
#include <cstdio>
#include <numbers>
#include <stdexcept>

#include "tests/verification/support/run_scene.hpp"

namespace undula {
namespace {

using namespace verification;

// DFG 2D-1, force = C * density U^2 D / 2 = C * 0.002 N/m (Nabh 1998).
constexpr double drag_2d1 = 5.57953523384 * 0.002, lift_2d1 = 0.010618948146 * 0.002;
constexpr double drop_2d1 = 0.11752016697 / 133.322387415; // mmHg

TEST(SceneFlow, CylinderOfTheChannelBenchmark) {
  const auto run = run_scene("cylinder_2d1", {});
  const double drag = run.last("cylinder_force_x_N_per_m"), lift = run.last("cylinder_force_y_N_per_m");
  const double drop = run.last("front_pressure_mmHg") - run.last("back_pressure_mmHg");
  std::printf(
      "scene cylinder_2d1, %d unknowns: drag %+.2f %%   lift %.5f (exact %.5f) %% of drag   drop %+.2f %%\n",
      run.unknowns, 100 * (drag / drag_2d1 - 1), 100 * lift / drag_2d1, 100 * lift_2d1 / drag_2d1,
      100 * (drop / drop_2d1 - 1));
  EXPECT_LT(std::abs(drag / drag_2d1 - 1), 0.02);
  EXPECT_LT(std::abs(lift - lift_2d1), 0.002 * drag_2d1);
  EXPECT_LT(std::abs(drop / drop_2d1 - 1), 0.03);
  // What comes in goes out; linear elements cut the parabola's top off.
  EXPECT_NEAR(run.last("outlet_outflow_cm2_per_s"), 20.0 * 41.0, 2e-3 * 820);
}

TEST(SceneFlow, RigidFlagBehindTheCylinder) {
  const auto run = run_scene("turek_hron_cfd1", {});
  const double drag = run.last("cylinder_and_flag_force_x_N_per_m"),
               lift = run.last("cylinder_and_flag_force_y_N_per_m");
  std::printf("scene turek_hron_cfd1, %d unknowns: drag %.4f (14.29), lift %.4f (1.119) N/m\n", run.unknowns,
              drag, lift);
  EXPECT_LT(std::abs(drag / 14.29 - 1), 0.03);
  EXPECT_LT(std::abs(lift / 1.119 - 1), 0.05);
}

TEST(SceneFlow, ClosedValveHoldsAPressureJumpWithoutLeaking) {
  const auto run = run_scene("closed_valve", {});
  std::printf("scene closed_valve: %g %g mmHg, outflow %g cm^2/s, speed %g cm/s\n",
              run.last("upstream_pressure_mmHg"), run.last("downstream_pressure_mmHg"),
              run.last("outlet_outflow_cm2_per_s"), run.last("speed_max_cm_per_s"));
  EXPECT_NEAR(run.last("upstream_pressure_mmHg"), 10.0, 1e-3);
  EXPECT_NEAR(run.last("downstream_pressure_mmHg"), 0.0, 1e-3);
  EXPECT_LT(std::abs(run.last("outlet_outflow_cm2_per_s")), 1e-6);
  EXPECT_LT(run.last("speed_max_cm_per_s"), 1e-3);
}

/// Time between the first and the third crossing of 0 after `from`: one period of an oscillation about 0.
double period_after(const SceneRun& run, const std::string& name, double from) {
  const auto time = run.column("time_s"), value = run.column(name);
  std::vector<double> crossings;
  for (std::size_t i = 1; i < value.size(); ++i)
    if (time[i - 1] >= from && value[i - 1] * value[i] < 0)
      crossings.push_back(time[i - 1] + (time[i] - time[i - 1]) * value[i - 1] / (value[i - 1] - value[i]));
  if (crossings.size() < 3) throw std::runtime_error(name + " does not oscillate for a period");
  return crossings[2] - crossings[0];
}

// Mode n = 2 in an annulus of fluid, dry 2.55504219581 rad/s, wet / dry 0.706255722648.
TEST(SceneFlow, RingThatSwingsInFluid) {
  const std::vector<std::string> coarse = {"time.step_s=0.04", "domain.size_mm=100", "body.ring.size_mm=70"};
  auto dry = coarse, wet = coarse;
  dry.insert(dry.end(), {"fluid.density_g_per_cm3=1e-9", "fluid.viscosity_poise=1e-12", "time.end_s=4"});
  wet.insert(wet.end(), {"time.end_s=5.6"});
  const double dry_period = period_after(run_scene("elastic_ring", dry), "A_displacement_x_mm", 0.1);
  const auto run = run_scene("elastic_ring", wet);
  const double ratio = dry_period / period_after(run, "A_displacement_x_mm", 0.1);
  const double frequency = 2 * std::numbers::pi / dry_period;
  std::printf("scene elastic_ring, %d unknowns: dry %.5f rad/s (%+.2f %%), wet / dry %.5f (%+.2f %%)\n",
              run.unknowns, frequency, 100 * (frequency / 2.55504219581 - 1), ratio,
              100 * (ratio / 0.706255722648 - 1));
  EXPECT_LT(std::abs(frequency / 2.55504219581 - 1), 0.01);
  EXPECT_LT(std::abs(ratio / 0.706255722648 - 1), 0.004);
}

// Squeeze film of a disc: 3 pi mu R^4 V / (2 h^3) + 15 pi rho R^4 V^2 / (56 h^2), R 1 cm, V 0.1 cm/s.
TEST(SceneFlow, DiscThatClosesUponAWall) {
  const auto run =
      run_scene("disc_squeeze", {"time.step_s=0.1", "domain.size_mm=0.2", "refine.gap.size_mm=0.04"});
  const auto force = run.column("disc_force_z_mN"), move = run.column("disc_displacement_z_mm");
  const auto error = [&](std::size_t row) {
    const double h = (1.0 + move.at(row)) / 10, pi = std::numbers::pi;
    return force.at(row) / (0.01 * (0.15 * pi / (h * h * h) * 1.0 + 15 * pi * 0.01 / (56 * h * h))) - 1;
  };
  std::printf("scene disc_squeeze, %d unknowns: h/R 0.05 %+.2f %%, 0.02 %+.2f %%\n", run.unknowns,
              100 * error(4), 100 * error(7));
  EXPECT_LT(std::abs(error(4)), 0.02);
  EXPECT_LT(std::abs(error(7)), 0.06);
  // What the disc sweeps leaves at its rim.
  EXPECT_NEAR(run.last("rim_outflow_l_per_min"), std::numbers::pi * 0.1 * 0.06, 1e-6);
}

// Brenner (1961), in parts of 6 pi mu R V = 0.00942478 mN; h/R = 0.5 and 0.1.
TEST(SceneFlow, SphereThatComesToAWall) {
  const auto lambda = [](double centre) {
    const auto run =
        run_scene("sphere_to_wall", {"body.sphere.centre_mm=[0.0, " + std::to_string(centre) + "]",
                                     "body.sphere.size_mm=0.25", "time.step_s=0.02", "time.end_s=0.04"});
    const double value = run.last("sphere_force_z_mN") / 0.00942478;
    std::printf("scene sphere_to_wall, %d unknowns: lambda %.4f\n", run.unknowns, value);
    return value;
  };
  EXPECT_LT(std::abs(lambda(7.54) / 3.20539 - 1), 0.015);
  EXPECT_LT(std::abs(lambda(5.54) / 11.45916 - 1), 0.02);
}

// Shapiro, Jaffrin & Weinberg (1969), amplitude / radius 0.4, no rise of pressure: theta_0 = 0.510968.
TEST(SceneFlow, DISABLED_WaveOfContractionPumps) {
  const auto run = run_scene("peristalsis", {"time.step_s=2.5", "time.end_s=110"});
  const auto in = run.column("begin_outflow_l_per_min"), out = run.column("end_outflow_l_per_min");
  double mean = 0;
  for (std::size_t row = out.size() - 40; row < out.size(); ++row) mean += (out[row] - in[row]) / 2 / 40;
  const double theta = mean / 0.06 / (std::numbers::pi * 0.3);
  std::printf("scene peristalsis, %d unknowns: theta_0 %.5f (%+.2f %%)\n", run.unknowns, theta,
              100 * (theta / 0.510968 - 1));
  EXPECT_LT(std::abs(theta / 0.510968 - 1), 0.015);
}

// Energy never grows; 1 / omega^2 is linear in the density of the plate, slope thickness / (D k^4).
TEST(SceneFlow, PlateMuchLighterThanTheFluid) {
  const auto inverse_square = [](const std::string& density) {
    const auto run = run_scene("added_mass", {"body.plate.density_g_per_cm3=" + density, "time.end_s=0.3"});
    const auto kinetic = run.column("kinetic_energy_uJ_per_cm"),
               elastic = run.column("elastic_energy_uJ_per_cm");
    const auto time = run.column("time_s");
    for (std::size_t row = 1; row < time.size(); ++row)
      if (time[row - 1] > 0.041) {
        EXPECT_LT(kinetic[row] + elastic[row], kinetic[row - 1] + elastic[row - 1]);
      }
    const double period = period_after(run, "middle_displacement_y_mm", 0.05);
    std::printf("scene added_mass, %d unknowns, density %s: %.4f rad/s\n", run.unknowns, density.c_str(),
                2 * std::numbers::pi / period);
    return std::pow(period / (2 * std::numbers::pi), 2);
  };
  const double light = inverse_square("1e-3"), heavy = inverse_square("10");
  const double slope = (heavy - light) / 9.999;
  std::printf("slope of 1 / omega^2 %.4e (thin plate 2.0138e-5, %+.2f %%)\n", slope,
              100 * (slope / 2.0138e-5 - 1));
  EXPECT_LT(std::abs(slope / 2.0138e-5 - 1), 0.05);
}

} // namespace
} // namespace undula
