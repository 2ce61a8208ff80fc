// Keys of a scene that a campaign varies beside its operating point (training.vary).
#pragma once

#include <string>
#include <vector>

#include "fom/scene/scene.hpp"
#include "training/training.hpp"

namespace undula::training {

/// In the unit of the key.
struct VariedKey {
  std::string key, unit;
  double low = 0, high = 0;
  double stated = 0; ///< by the scene
};

/// Reads training.vary, "section.key=low:high" each, in its order. Throws InputError for a text that cannot
/// be read, a key that is unknown, repeated, no real number or one of the operating point, a range that is
/// empty, not allowed or without the scene's own value, and for any of them in a scene that trains no
/// emulator.
std::vector<VariedKey> varied_keys(const Scene& scene);

/// The scene at a point of a campaign.
Scene at_point(const Scene& scene, const OperatingPoint& point);

} // namespace undula::training
