// What ties a stored result to the scene it came from.
#pragma once

#include <string>

#include "fom/scene/scene.hpp"

namespace undula::fom {

/// Two results may be mixed (restart, campaign) only if their hashes agree.
struct SceneStamp {
  std::string hash; ///< of the keys that shape the result
  std::string text; ///< the resolved scene, TOML
};

/// Of one run: scene_hash and scene_to_toml.
SceneStamp stamp_scene(const Scene& scene);

} // namespace undula::fom
