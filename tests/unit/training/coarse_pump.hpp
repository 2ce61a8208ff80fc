// The shipped pump on a mesh and a time grid coarse enough for a unit test.
#pragma once

#include <string>
#include <vector>

#include "fom/scene/scene_file.hpp"
#include "training/training.hpp"

namespace undula::training {

inline Scene coarse_pump(std::vector<std::string> overrides = {}) {
  std::vector<std::string> all = {
      "mesh.gap_elements=2",      "mesh.channel_size_mm=1.5",         "mesh.growth=1",
      "time.steps_per_period=24", "training.snapshots_per_period=24", "time.periods=12"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  return read_scene(UNDULA_SOURCE_DIR "/data/scenes/wave_pump_fixed.toml", all);
}

} // namespace undula::training
