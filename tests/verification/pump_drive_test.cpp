// The pump driven by a voltage, finite elements: what the coil puts in over a period, with every coupling.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "fom/levels/finite_element_level.hpp"
#include "fom/levels/periodic_run.hpp"
#include "fom/scene/scene_file.hpp"
#include "tests/verification/support/names.hpp"

namespace undula::verification {
namespace {

constexpr int steps_per_period = 96;

struct DrivenPump {
  Scene scene;
  std::vector<Observation> steps;
};

DrivenPump run(const std::string& coupling, const std::string& solid) {
  const std::vector<std::string> overrides{"model.coupling=" + coupling,
                                           "model.solid=" + solid,
                                           "operating_point.voltage_V=8", // no contact
                                           "operating_point.head_mmHg=10",
                                           "actuator.damping_N_s_per_m=5",
                                           "mesh.gap_elements=2",
                                           "mesh.channel_size_mm=2.5",
                                           "mesh.membrane_size_mm=0.6",
                                           "mesh.growth=0.6",
                                           "time.steps_per_period=" + std::to_string(steps_per_period),
                                           "time.periods=2",
                                           "time.ramp_periods=0.5",
                                           "training.periodic_tolerance=1e-9"};
  DrivenPump pump{
      read_scene(std::string(UNDULA_SOURCE_DIR) + "/data/scenes/wave_pump_explicit_voltage.toml", overrides),
      {}};
  PhaseTimer timer;
  FiniteElementLevel level(pump.scene, PETSC_COMM_SELF, timer);
  State state = level.initial_state();
  const PeriodicRun marched = march_until_periodic(
      level, pump.scene, state, [&](const State&, const Observation& seen) { pump.steps.push_back(seen); });
  EXPECT_NE(marched.state, RunState::failed) << marched.reason;
  return pump;
}

/// Energy of mass and spring, erg.
double stored(const ActuatorSettings& actuator, const HolderObservation& holder) {
  return 0.5 * (actuator.moving_mass * holder.velocity * holder.velocity +
                actuator.stiffness * holder.displacement * holder.displacement);
}

// Over a period the work of the coil is that on membrane and fluid, what damping takes, and what mass and
// spring keep because the motion does not repeat yet.
TEST(PumpDrive, CoilFeedsHolderAndDamping) {
  for (const auto& [coupling, solid] : {std::pair<std::string, std::string>{"fixed", "linear"},
                                        {"explicit", "neo-hookean"},
                                        {"mapped", "neo-hookean"}}) {
    SCOPED_TRACE(coupling);
    const auto pump = run(coupling, solid);
    ASSERT_EQ(pump.steps.size(), 2 * steps_per_period);
    const auto& actuator = pump.scene.actuator;
    const double dt = 1 / (pump.scene.operating_point.frequency * steps_per_period);
    double coil = 0, holder = 0, damping = 0;
    for (std::size_t i = steps_per_period; i < pump.steps.size(); ++i) {
      const auto& seen = pump.steps[i];
      coil += dt * seen.holder.actuator_power;
      holder += dt * seen.energy.holder;
      damping += dt * actuator.damping * seen.holder.velocity * seen.holder.velocity;
    }
    const double kept = stored(actuator, pump.steps.back().holder) -
                        stored(actuator, pump.steps[steps_per_period - 1].holder);
    std::printf("%s, %s: coil %.2f erg, holder %.2f, damping %.2f, kept %.2f (%+.3f %% not accounted for)\n",
                coupling.c_str(), solid.c_str(), coil, holder, damping, kept,
                100 * (1 - (holder + damping + kept) / coil));
    EXPECT_NEAR((holder + damping + kept) / coil, 1, 1e-3);
    EXPECT_GT(holder, 0.3 * coil);
    EXPECT_GT(damping, 0.05 * coil);
  }
}

} // namespace
} // namespace undula::verification
