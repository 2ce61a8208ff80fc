// Which key did the user mean?
#pragma once

#include <string>
#include <string_view>

#include "fom/scene/scene_table.hpp"

namespace undula::fom {

/// Levenshtein distance: insertions, deletions and replacements of single characters that lead from a to b.
int edit_distance(std::string_view a, std::string_view b);

/// The key with this path, nullptr if there is none.
const SceneKey* find_key(std::string_view path);

/// The key that names the same quantity in another unit ("operating_point.stroke_cm" -> stroke_mm), or
/// nullptr.
const SceneKey* same_quantity(std::string_view path);

/// The key nearest to an unknown path, by edit distance of the whole path or of the leaf in another section.
const SceneKey& nearest_key(std::string_view path);

/// The same among the keys that hold a real number.
const SceneKey& nearest_real_key(std::string_view path);

/// Whether keys exist below this section name.
bool is_section(std::string_view name);

} // namespace undula::fom
