// Contact with rigid bodies against closed forms: Hertz's cylinder and ball, a closed cycle, a rolling
// cylinder, a sliding block.
#include <cmath>
#include <cstdio>
#include <numbers>

#include "tests/verification/support/run_scene.hpp"

namespace undula::verification {
namespace {

constexpr double mm = 0.1, N_per_m = 1000, mN = 100; // cgs
constexpr double modulus = 1e7 / (1 - 0.3 * 0.3);    // E* of the scenes, dyn/cm^2

TEST(HertzContact, CylinderOnABlockHasItsPressureAndWidth) {
  const auto run = run_scene("hertz_cylinder", {});
  const double load = run.last("cyl_load_N_per_m") * N_per_m, R = 20 * mm;
  const double a = std::sqrt(4 * load * R / (std::numbers::pi * modulus)),
               p = std::sqrt(load * modulus / (std::numbers::pi * R));
  const double width = 0.5 * run.last("cyl_length_mm") * mm,
               pressure = run.last("cyl_pressure_max_dyn_per_cm2");
  std::printf(
      "%d unknowns, load %.1f N/m: half width %.4f mm (%+.2f %%), pressure %.4g dyn/cm^2 (%+.2f %%)\n",
      run.unknowns, load / N_per_m, width / mm, 100 * (width / a - 1), pressure, 100 * (pressure / p - 1));
  EXPECT_GT(a, 0.8 * mm); // the cylinder is pressed in by as much as was meant
  EXPECT_NEAR(width, a, 0.02 * a);
  EXPECT_NEAR(pressure, p, 0.02 * p);
  EXPECT_NEAR(run.last("cyl_force_y_N_per_m") * N_per_m, -load, 0.005 * load); // on the block, less its slope
  EXPECT_LT(run.last("cyl_penetration_mm"), 0.002 * 0.1);                      // of the approach
}

TEST(HertzContact, BallOnAHalfSpaceHasItsPressureAndWidth) {
  const auto run = run_scene("hertz_sphere", {});
  const double load = run.last("ball_on_block_load_mN") * mN, R = 20 * mm;
  const double a = std::cbrt(3 * load * R / (4 * modulus)), p = 1.5 * load / (std::numbers::pi * a * a);
  const double radius = run.last("ball_on_block_length_mm") * mm,
               pressure = run.last("ball_on_block_pressure_max_dyn_per_cm2");
  std::printf("%d unknowns, load %.2f mN: radius %.4f mm (%+.2f %%), pressure %.4g dyn/cm^2 (%+.2f %%)\n",
              run.unknowns, load / mN, radius / mm, 100 * (radius / a - 1), pressure,
              100 * (pressure / p - 1));
  EXPECT_GT(a, 0.8 * mm);
  EXPECT_NEAR(radius, a, 0.02 * a);
  EXPECT_NEAR(pressure, p, 0.02 * p);
}

/// Work of the cylinder on the block by the trapezoidal rule: what goes in on the way down comes back.
TEST(HertzContact, AClosedCycleLosesLessThanAThousandth) {
  const auto run = run_scene("hertz_cylinder", {"rigid.roller.displacement_mm=[\"0\", \"-0.05*min(t, 4-t)\"]",
                                                "time.end_s=4", "refine.contact.size_mm=0.2"});
  const auto load = run.column("cyl_force_y_N_per_m"), energy = run.column("cyl_energy_uJ_per_cm"),
             elastic = run.column("elastic_energy_uJ_per_cm");
  double in = 0, out = 0, before = 0, place = 0;
  for (std::size_t k = 0; k < load.size(); ++k) {
    const double t = run.table.value(k, 0), now = -0.05 * std::min(t, 4 - t),
                 work = 0.5 * (load[k] + before) * (now - place);
    (work > 0 ? in : out) += std::abs(work);
    before = load[k];
    place = now;
  }
  const double stored = *std::max_element(elastic.begin(), elastic.end());
  std::printf("in %.6g, out %.6g, lost %.2e; stored at most %.4g uJ/cm, at the end %.2e\n", in, out,
              (in - out) / in, stored, elastic.back() + energy.back());
  EXPECT_GT(in, 0);
  EXPECT_LT(std::abs(in - out), 1e-3 * in);
  EXPECT_LT(elastic.back() + energy.back(), 1e-3 * stored);
}

/// A cylinder that is pressed 0.1 mm into the block and moved along it by 4 mm, at 1 mm/s.
SceneRun move_along(std::vector<std::string> settings) {
  settings.insert(settings.end(), {"rigid.roller.displacement_mm=[\"max(t-1,0)\", \"-0.1*min(t,1)\"]",
                                   "time.end_s=5", "time.step_s=0.125",
                                   "refine.contact.box_mm=[[-1,-0.5],[5,0]]", "refine.contact.size_mm=0.2"});
  return run_scene("hertz_cylinder", settings);
}

TEST(RollingContact, ACylinderRollsOverALayerWithoutResistance) {
  const auto run = move_along({"rigid.roller.angle_deg=-max(t-1,0)/20*180/pi"});
  const auto load = run.column("cyl_load_N_per_m"), along = run.column("cyl_force_x_N_per_m");
  double least = 1e300, most = 0, drag = 0;
  for (std::size_t k = 15; k < load.size(); ++k) {
    least = std::min(least, load[k]);
    most = std::max(most, load[k]);
    drag = std::max(drag, std::abs(along[k]));
  }
  std::printf("load %.2f .. %.2f N/m, along %.3f N/m\n", least, most, drag);
  EXPECT_GT(least, 0);
  EXPECT_LT(most - least, 0.01 * most);
  EXPECT_LT(drag, 0.01 * most);
}

TEST(RollingContact, ACylinderThatDoesNotTurnIsHeldBackByFriction) {
  const auto run = move_along({"pair.cyl.friction=0.3", "pair.cyl.creep_cm_per_s=0.002"});
  const auto load = run.column("cyl_load_N_per_m"), along = run.column("cyl_force_x_N_per_m"),
             lost = run.column("cyl_friction_power_mW_per_cm");
  // The skin turns a little under friction, so the pressure takes 1 % of the force along (Johnson 1985, ch.
  // 7).
  for (std::size_t k = 25; k < load.size(); ++k) { // slides all over
    EXPECT_NEAR(along[k], 0.3 * load[k], 0.02 * 0.3 * load[k]);
    EXPECT_NEAR(lost[k], along[k] * 0.01, 0.003 * along[k] * 0.01); // N/m times 0.1 cm/s: 0.01 mW/cm
  }
  std::printf("load %.3f N/m, along %.3f N/m, lost %.4f mW/cm\n", load.back(), along.back(), lost.back());
}

TEST(SlidingContact, ABlockStopsWhereCoulombSays) {
  const auto run = run_scene("sliding_block", {});
  const double expected = 20.0 * 20.0 / (2 * 0.3 * 981) / mm; // mm
  const double way = run.last("corner_displacement_x_mm");
  const auto lost = run.column("slide_friction_power_mW_per_cm");
  double dissipated = 0;
  for (const double power : lost) dissipated += power * run.scene.time.step; // mJ/cm
  const double kinetic = 0.5 * 0.3 * 20 * 20 * 1e-4;                         // of 0.3 g/cm
  std::printf("stops after %.4f mm (%+.2f %%), dissipated %.5f of %.5f mJ/cm (%+.2f %%), load %.4f N/m\n",
              way, 100 * (way / expected - 1), dissipated, kinetic, 100 * (dissipated / kinetic - 1),
              run.last("slide_load_N_per_m"));
  EXPECT_NEAR(way, expected, 0.02 * expected);
  EXPECT_NEAR(dissipated, kinetic, 0.02 * kinetic);
  EXPECT_NEAR(run.last("slide_load_N_per_m"), 0.3 * 981 / N_per_m, 1e-3 * 0.3);
}

} // namespace
} // namespace undula::verification
