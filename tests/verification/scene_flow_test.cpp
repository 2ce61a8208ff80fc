// Flows that a scene file states, against published values.
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "tests/verification/support/run_scene.hpp"
#include "tests/verification/support/tube_wave.hpp"

namespace undula::verification {
namespace {

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

// CFD1 of Turek & Hron (2006): drag 14.29, lift 1.119 N/m.
TEST(SceneFlow, RigidFlagBehindTheCylinder) {
  const auto run = run_scene("turek_hron_cfd1", {"time.end_s=8e4"});
  const double drag = run.last("cylinder_and_flag_force_x_N_per_m"),
               lift = run.last("cylinder_and_flag_force_y_N_per_m");
  std::printf("scene turek_hron_cfd1, %d unknowns: drag %.4f (%+.2f %%), lift %.4f (%+.2f %%) N/m\n",
              run.unknowns, drag, 100 * (drag / 14.29 - 1), lift, 100 * (lift / 1.119 - 1));
  EXPECT_LT(std::abs(drag / 14.29 - 1), 0.004);
  EXPECT_LT(std::abs(lift / 1.119 - 1), 0.01);
}

/// CFD1 with quadratic velocities on 16,000 unknowns instead of 40,000.
TEST(SceneFlow, RigidFlagBehindTheCylinderByQuadraticVelocities) {
  const auto run =
      run_scene("turek_hron_cfd1", {"space.order=2", "domain.size_mm=60", "domain.growth=0.3",
                                    "boundary.cylinder.size_mm=5", "body.flag.fluid_size_mm=12",
                                    "boundary.inlet.size_mm=40", "refine.tip.size_mm=1", "time.end_s=1e5"});
  const double drag = run.last("cylinder_and_flag_force_x_N_per_m"),
               lift = run.last("cylinder_and_flag_force_y_N_per_m");
  std::printf("CFD1, P2-P1: %d unknowns, drag %.4f (%+.2f %%), lift %.4f (%+.2f %%)\n", run.unknowns, drag,
              100 * (drag / 14.29 - 1), lift, 100 * (lift / 1.119 - 1));
  EXPECT_LT(std::abs(drag / 14.29 - 1), 0.0015);
  EXPECT_LT(std::abs(lift / 1.119 - 1), 0.01);
}

/// CFD3 of Turek & Hron (2006; drag 439.45 N/m) with steps in which the flow crosses ten elements of the
/// skin: with an extrapolated convecting velocity the drag is ten times too high.
TEST(SceneFlow, RigidFlagAtRe200ByLongSteps) {
  const auto run =
      run_scene("turek_hron_cfd1",
                {"constants.U=200", "time.scheme=bdf2", "time.step_s=0.01", "time.end_s=1",
                 "output.statistics_from_s=0.8", "space.order=2", "domain.size_mm=60", "domain.growth=0.3",
                 "boundary.cylinder.size_mm=5", "body.flag.fluid_size_mm=12", "boundary.inlet.size_mm=40",
                 "boundary.outlet.stress=static-pressure", "boundary.outlet.tangential=free",
                 R"x(boundary.inlet.velocity_cm_per_s=["6*U*y*(H - y)/H^2*ramp(t, 0.6)","0"])x"});
  const double drag = run.last("cylinder_and_flag_force_x_N_per_m");
  std::printf("CFD3, P2-P1, steps of 10 ms: %d unknowns, drag %.1f (%+.2f %%) N/m\n", run.unknowns, drag,
              100 * (drag / 439.45 - 1));
  EXPECT_LT(std::abs(drag / 439.45 - 1), 0.03);
}

/// Errors of FSI1 of Turek & Hron (2006) against 0.02270493, 0.8208773 mm, 14.29426, 0.7637460 N/m.
std::array<double, 4> flag_errors(const char* name, const SceneRun& run) {
  const std::array<double, 4> errors = {run.last("A_displacement_x_mm") / 0.02270493 - 1,
                                        run.last("A_displacement_y_mm") / 0.8208773 - 1,
                                        run.last("cylinder_and_flag_force_x_N_per_m") / 14.29426 - 1,
                                        run.last("cylinder_and_flag_force_y_N_per_m") / 0.7637460 - 1};
  std::printf("scene turek_hron_fsi1, %s, %d unknowns: ux %+.2f, uy %+.2f, drag %+.2f, lift %+.2f %%\n", name,
              run.unknowns, 100 * errors[0], 100 * errors[1], 100 * errors[2], 100 * errors[3]);
  return errors;
}

TEST(SceneFlow, FlagBentByTheFlow) {
  const auto errors = flag_errors(
      "coarse", run_scene("turek_hron_fsi1", {"domain.growth=0.1", "body.flag.size_mm=10",
                                              "refine.tip.size_mm=2", "time.step_s=0.25", "time.end_s=8"}));
  EXPECT_LT(std::abs(errors[0]), 0.02);
  EXPECT_LT(std::abs(errors[1]), 0.05);
  EXPECT_LT(std::abs(errors[2]), 0.01);
  EXPECT_LT(std::abs(errors[3]), 0.04);
}

TEST(SceneFlow, DISABLED_FlagBentByTheFlowAsShipped) {
  const auto errors = flag_errors("as shipped", run_scene("turek_hron_fsi1", {}));
  EXPECT_LT(std::abs(errors[0]), 0.01);
  EXPECT_LT(std::abs(errors[1]), 0.01);
  EXPECT_LT(std::abs(errors[2]), 0.003);
  EXPECT_LT(std::abs(errors[3]), 0.01);
}

/// FSI2 on a mesh twice as coarse as shipped, up to half of its full swing: the frequency, the drag as
/// the flag passes its middle (215.06 - 77.65 N/m of the full swing, and no less at half of it) and that the
/// swing feeds on the flow.
void flag_swings(const std::string& coupling) {
  const auto run = run_scene("turek_hron_fsi2",
                             {"model.coupling=" + coupling, "constants.T=0.5", "body.flag.fluid_size_mm=10",
                              "body.flag.size_mm=20", "boundary.cylinder.size_mm=8", "domain.size_mm=50",
                              "domain.growth=0.15", "time.step_s=0.01", "time.end_s=2.7"});
  const auto time = run.column("time_s"), rise = run.column("A_displacement_y_mm"),
             drag = run.column("cylinder_and_flag_force_x_N_per_m");
  std::vector<double> upwards, swings;
  double least_drag = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i + 1 < time.size(); ++i) {
    if (time[i] < 1.1) continue; // the push is over
    if (rise[i - 1] < 0 && rise[i] >= 0)
      upwards.push_back(time[i] - (time[i] - time[i - 1]) * rise[i] / (rise[i] - rise[i - 1]));
    if (rise[i] > rise[i - 1] && rise[i] >= rise[i + 1]) swings.push_back(rise[i]);
    if (time[i] > 1.5) least_drag = std::min(least_drag, drag[i]);
  }
  ASSERT_GE(upwards.size(), 3u);
  ASSERT_GE(swings.size(), 3u);
  const double frequency = static_cast<double>(upwards.size() - 1) / (upwards.back() - upwards.front());
  std::printf("scene turek_hron_fsi2, %s, %d unknowns: %.3f Hz (1.93), swings", coupling.c_str(),
              run.unknowns, frequency);
  for (const double swing : swings) std::printf(" %.1f", swing);
  std::printf(" mm, least drag %.1f N/m (137.4)\n", least_drag);
  EXPECT_LT(std::abs(frequency / 1.93 - 1), 0.03);
  EXPECT_LT(std::abs(least_drag / 137.41 - 1), 0.02);
  for (std::size_t i = 1; i < swings.size(); ++i) EXPECT_GT(swings[i], 1.1 * swings[i - 1]);
  EXPECT_LT(swings.back(), 90);
}

TEST(SceneFlow, FlagThatSwingsBehindTheCylinder) { flag_swings("explicit"); }
TEST(SceneFlow, FlagThatSwingsBehindTheCylinderByAMap) { flag_swings("mapped"); }

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

/// Metres, kg, s; as the scene compliant_tube.
constexpr Tube compliant_tube = {1, 0.1, 2e4, 0.3, 1000, 1000, 5, 0.02};
constexpr Complex tube_wave = {0.143978370716, -0.0207265896512}; // 1/m

TEST(SceneFlow, TubeWaveIsTheRootOfTheExactRelation) {
  const auto k = tube_wave_number(compliant_tube, {0.14, -0.02});
  EXPECT_LT(std::abs(k - tube_wave), 1e-11);
  std::printf("wave number of the tube %.12f %+.13fi; the wall's own slow wave %.4f %+.4fi 1/m\n", k.real(),
              k.imag(), tube_wave_number(compliant_tube, {0.04, -0.01}).real(),
              tube_wave_number(compliant_tube, {0.04, -0.01}).imag());
}

/// Amplitude of exp(i w t) in the last period.
Complex harmonic(const SceneRun& run, const std::string& name, double frequency) {
  const auto time = run.column("time_s"), value = run.column(name);
  const auto rows = static_cast<std::size_t>(std::lround(1 / (frequency * (time[1] - time[0]))));
  Complex sum = 0;
  for (std::size_t row = value.size() - rows; row < value.size(); ++row)
    sum += value[row] * std::polar(1.0, -2 * std::numbers::pi * frequency * time[row]);
  return 2.0 / double(rows) * sum;
}

/// Wave number, 1/m, of amplitudes at z = 3, 6, 9, 12 m, whatever runs forth and back.
Complex wave_number(const std::array<Complex, 4>& q) {
  const Complex cosine = (std::conj(q[1]) * (q[0] + q[2]) + std::conj(q[2]) * (q[1] + q[3])) /
                         (2 * (std::norm(q[1]) + std::norm(q[2])));
  const Complex k = std::acos(cosine) / 3.0;
  return k.real() > 0 ? k : -k;
}

/// Largest errors of wave speed and attenuation, by the pressure on the axis and by the wall's motion.
std::array<double, 2> tube_errors(const SceneRun& run) {
  std::array<double, 2> largest = {0, 0};
  for (const bool wall : {false, true}) {
    std::array<Complex, 4> q;
    for (int n = 0; n < 4; ++n) {
      const std::string place = std::string(n < 3 ? "0" : "") + std::to_string(3 * n + 3);
      q[n] = harmonic(run, wall ? "wall" + place + "_displacement_r_mm" : "p" + place + "_pressure_mmHg",
                      compliant_tube.frequency);
    }
    const Complex k = wave_number(q);
    const double speed = tube_wave.real() / k.real() - 1, attenuation = k.imag() / tube_wave.imag() - 1;
    std::printf("scene compliant_tube, %d unknowns, by the %s: wave speed %+.2f %%, attenuation %+.2f %%\n",
                run.unknowns, wall ? "wall" : "pressure", 100 * speed, 100 * attenuation);
    largest = {std::max(largest[0], std::abs(speed)), std::max(largest[1], std::abs(attenuation))};
  }
  return largest;
}

TEST(SceneFlow, WaveInACompliantTube) {
  const auto errors = tube_errors(run_scene("compliant_tube", {"time.step_s=1", "time.end_s=300"}));
  EXPECT_LT(errors[0], 0.015);
  EXPECT_LT(errors[1], 0.03);
}

TEST(SceneFlow, DISABLED_WaveInACompliantTubeAsShipped) {
  const auto errors = tube_errors(run_scene("compliant_tube", {}));
  EXPECT_LT(errors[0], 0.005);
  EXPECT_LT(errors[1], 0.02);
}

/// Pressure pulse in an elastic tube, coarse: 0.157 to 0.1585 mm are published for schemes of second order, a
/// quarter less for backward Euler with steps of 0.1 ms.
TEST(SceneFlow, PulseInAnElasticTube) {
  const auto largest = [](const char* scheme) {
    const auto run =
        run_scene("tube_pulse", {std::string("time.scheme=") + scheme, "time.step_s=1e-4", "time.end_s=0.008",
                                 "body.wall.size_mm=0.5", "body.wall.fluid_size_mm=0.6"});
    return std::ranges::max(run.column("mid_displacement_r_mm"));
  };
  const double second = largest("bdf2"), first = largest("bdf1");
  std::printf("pulse in a tube, coarse: %.4f mm (BDF2), %.4f mm (BDF1)\n", second, first);
  EXPECT_NEAR(second, 0.15775, 0.07 * 0.15775);
  EXPECT_NEAR(first, 0.1215, 0.05 * 0.1215);
}

} // namespace
} // namespace undula::verification
