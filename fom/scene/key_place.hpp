// Where a key of a scene was stated, for messages.
#pragma once

#include <string>

#include "fom/scene/scene.hpp"

namespace undula::fom {

/// "pump.toml:12, key \"body.flag.size_mm\"", with the line where it is known; `scene_name` where it is not.
inline std::string place_of_key(const Scene& scene, const std::string& path, const std::string& scene_name) {
  const auto found = scene.places.find(path);
  return (found == scene.places.end() ? scene_name : found->second) + ", key \"" + path + "\"";
}

} // namespace undula::fom
