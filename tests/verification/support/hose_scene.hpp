// Scenes of the peristaltic pump that verification states in code.
#pragma once

#include <string>
#include <vector>

#include "fom/levels/march.hpp"
#include "fom/scene/scene_file.hpp"
#include "tests/verification/support/names.hpp"

namespace undula::verification {

/// A hose of 6.4 mm bore between three rollers and a track of 200 degrees.
inline Scene hose_scene(const std::vector<std::string>& overrides) {
  constexpr const char* text = R"(
name = "hose"
model = { machine = "peristaltic-pump", space = "long-wave" }
hose = { bore_mm = 6.4, wall_mm = 1.6, inlet_length_mm = 200.0, outlet_length_mm = 200.0 }
fluid = { density_g_per_cm3 = 1.0, viscosity_poise = 0.01 }
[rollers]
count = 3
radius_mm = 12.0
track_radius_mm = 60.0
track_angle_deg = 200.0
occlusion = 1.0
film_mm = 0.01
[operating_point]
frequency_Hz = 1.0
head_mmHg = 0.0
[time]
steps_per_period = 360
periods = 4
)";
  return parse_scene(text, "scene of the test", ".", overrides);
}

/// Observations of the last turn.
inline std::vector<Observation> last_turn(const Scene& scene) {
  PhaseTimer timer;
  const auto level = prepare_level(scene, MPI_COMM_SELF, timer);
  State state = level->initial_state();
  std::vector<Observation> seen;
  const int first = (scene.time.periods - 1) * scene.time.steps_per_period;
  march(*level, scene, state, timer, [&](const State& now, const Observation& observed) {
    if (now.step > first) seen.push_back(observed);
  });
  return seen;
}

/// Mean of what a function says of observations.
template <typename Value>
double mean_of(const std::vector<Observation>& turn, const Value& value) {
  double sum = 0;
  for (const Observation& seen : turn) sum += value(seen);
  return sum / static_cast<double>(turn.size());
}

} // namespace undula::verification
