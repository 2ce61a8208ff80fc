// The text of a scene, moved to another operating point.
#pragma once

#include <map>
#include <string>

namespace undula::apps {

/// `scene` (TOML, a key per line as scene_to_toml prints it) with other values of keys of [operating_point];
/// all other lines stay as they are, stated tolerances too. Keys that the section has not are put at its
/// begin. Throws InputError for a text without that section.
std::string scene_at_point(const std::string& scene, const std::map<std::string, double>& values);

} // namespace undula::apps
