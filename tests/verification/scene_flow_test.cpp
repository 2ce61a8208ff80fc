// Flows that a scene file states, against published values.
#include <cmath>
#include <cstdio>

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

} // namespace
} // namespace undula
