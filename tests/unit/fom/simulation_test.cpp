// From a scene to a run: the coarsest mesh of the pump, a few steps.
#include <gtest/gtest.h>

#include <numbers>

#include "fom/levels/march.hpp"
#include "fom/machines/wave_pump/pump_problem.hpp"
#include "fom/scene/scene_file.hpp"
#include "fom/scene/scene_time.hpp"

namespace undula::fom {
namespace {

/// The shipped scene on a coarse mesh. Clamped from `clamp_mm` on: at 5 mm the membrane is all holder.
Scene coarse_scene(const std::string& clamp_mm) {
  const std::vector<std::string> overrides{
      "mesh.gap_elements=2",       "mesh.channel_size_mm=2.5",
      "mesh.membrane_size_mm=0.8", "mesh.growth=0.6",
      "time.steps_per_period=96",  "time.periods=1",
      "time.ramp_periods=0.1",     "membrane.clamp_radius_mm=" + clamp_mm};
  return read_scene(std::string(UNDULA_SOURCE_DIR) + "/data/scenes/wave_pump_fixed.toml", overrides);
}

/// A membrane that is all holder is incompressible, so what enters leaves, to solver precision.
TEST(Simulation, MovesTheHolderAsTheSceneSaysAndKeepsTheVolume) {
  auto scene = coarse_scene("5.0");
  PhaseTimer timer;
  const auto level = prepare_level(scene, MPI_COMM_SELF, timer);
  EXPECT_DOUBLE_EQ(time_step(scene), 1 / (120.0 * 96));
  State state = level->initial_state();
  state.step = 84; // the run ends at the end of the scene's last period
  state.time = 84 * time_step(scene);
  int steps = 0;
  march(*level, scene, state, timer, [&](const State& now, const Observation& seen) {
    ++steps;
    EXPECT_EQ(seen.step, 84 + steps);
    EXPECT_EQ(now.step, seen.step);
    const double phase = 2 * std::numbers::pi * seen.step / 96.0;
    EXPECT_NEAR(seen.holder.displacement, 0.053 * std::sin(phase), 1e-12);
    EXPECT_NEAR(seen.tip_displacement, 0.053 * std::sin(phase), 1e-12);
    EXPECT_GT(std::abs(seen.outflow), 1e-3);
    EXPECT_NEAR(seen.inflow, seen.outflow, 1e-7 * std::abs(seen.outflow));
    EXPECT_NEAR(seen.hydraulic_power, 50 * 1333.22 * seen.outflow, 1e-4 * std::abs(seen.hydraulic_power));
  });
  EXPECT_EQ(steps, 12);
  EXPECT_EQ(state.step, 96);

  // Another operating point on the same meshes.
  scene.operating_point.stroke = 0.02;
  scene.operating_point.head = 0;
  State other = level->initial_state();
  other.step = 94;
  march(*level, scene, other, timer, [&](const State& now, const Observation& seen) {
    EXPECT_NEAR(seen.holder.displacement, holder_displacement(scene, now.time), 1e-12);
    EXPECT_EQ(seen.hydraulic_power, 0);
  });
}

TEST(Simulation, LetsTheMembraneBend) {
  auto scene = coarse_scene("0.0");
  PhaseTimer timer;
  const auto level = prepare_level(scene, MPI_COMM_SELF, timer);
  State state = level->initial_state();
  state.step = 84;
  Observation last;
  march(*level, scene, state, timer, [&](const State&, const Observation& seen) { last = seen; });
  EXPECT_NEAR(last.holder.displacement, 0, 1e-12); // a whole period
  EXPECT_GT(std::abs(last.tip_displacement), 1e-3);
  EXPECT_GT(last.clearance_min, 0);
}

} // namespace
} // namespace undula::fom
