// The JSON schema of scenes, for editors of TOML.
#pragma once

#include <nlohmann/json.hpp>

namespace undula::apps {

/// JSON Schema, draft 7, made from the table that parses scenes: names, types, ranges, choices, defaults,
/// help, and which keys a scene of a pump or a general problem needs. What involves several keys, files or
/// geometry is left to `undula check`.
nlohmann::ordered_json scene_schema();

} // namespace undula::apps
