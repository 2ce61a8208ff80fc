// What is different between two scenes, in words.
#pragma once

#include <string>
#include <vector>

#include "fom/scene/scene.hpp"

namespace undula::fom {

/// A key that two scenes state differently.
struct KeyDifference {
  std::string key;     ///< path, "time.step_s"
  std::string was, is; ///< TOML values, "nothing" where the key is missing
};

/// The keys that differ between two resolved scenes (texts of scene_to_toml), in the order of their paths.
/// Names of files are left out: what counts is their content.
std::vector<KeyDifference> differing_keys(const std::string& text_before, const std::string& text_now);

/// TOML value of a key in a resolved scene (text of scene_to_toml); "" where it is missing.
std::string recorded_value(const std::string& text, const std::string& key);

/// "time.step_s: was 0.01, is 0.02", the first few of a list; of an empty one, that it must be the content of
/// a file.
std::string difference_text(const std::vector<KeyDifference>& differences);

/// The same of the keys that shape the state: why the run of `text_before` cannot go on as one of `scene`.
std::string difference_text(const std::string& text_before, const Scene& scene);

} // namespace undula::fom
