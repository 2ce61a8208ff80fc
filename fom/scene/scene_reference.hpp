// Documentation made from the scene table.
#pragma once

#include <string>

namespace undula::fom {

/// The page docs/scene.md: every section, key, range, default and help text.
std::string scene_reference();

/// The same for a terminal: one key per line with what it accepts, for `--help`.
std::string scene_keys_help();

} // namespace undula::fom
