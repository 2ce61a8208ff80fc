// A scene to begin with: the values of another one, every key with its help.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace undula::fom {

struct CommentedSceneOptions {
  /// Values in place of those of the scene, by path ("geometry.profile"): texts.
  std::map<std::string, std::string> texts = {};
  bool all_keys = false; ///< also those that keep their defaults, commented out
};

/// The keys that `scene` (TOML) states, in the order of the reference, each below a comment that says what it
/// is and what it accepts. What stands in the scene as a comment is left out. Throws InputError for a text
/// that is no TOML.
std::string commented_scene(std::string_view scene, const CommentedSceneOptions& options);

} // namespace undula::fom
