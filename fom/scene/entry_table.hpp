// Sections of a scene that are repeated under names of the user's: [body.flag], [boundary.inlet], ... Their
// keys are those of the scene table, bound to one entry.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fom/scene/scene_table.hpp"

namespace undula::fom {

/// One kind of named entries.
struct EntryKind {
  std::string kind; ///< "body": its sections are [body.NAME]
  std::string help;
  Scope scope = Scope::general;   ///< scenes that may have them
  bool added_by_override = false; ///< `--set` makes those that the scene has not
};

/// All kinds, in the order of documentation.
std::span<const EntryKind> entry_kinds();

/// The keys of one entry, with paths "kind.name.key". Accessors throw std::out_of_range for scenes without
/// the entry.
std::span<const SceneKey> entry_keys(const std::string& kind, const std::string& name);

/// Null for names of other sections, [constants] among them.
const EntryKind* find_entry_kind(std::string_view name);

/// "body.flag.size_mm" or "body.flag" -> {"body", "flag"}; both empty where this names no entry.
struct EntryName {
  std::string kind, name;
  [[nodiscard]] explicit operator bool() const { return !kind.empty(); }
};
EntryName entry_of(std::string_view path);

/// Names of the entries of a kind that a scene has.
std::vector<std::string> entry_names(const Scene& scene, const std::string& kind);

/// Throws InputError, with the entries there are, if `path` names one that the scene has not.
void check_entry_exists(const Scene& scene, std::string_view path, const std::string& where);

/// Adds an entry, unless it is there.
void add_entry(Scene& scene, const std::string& kind, const std::string& name);

/// Section of constants for expressions: [constants], any name, any number.
inline constexpr const char* constants_section = "constants";

/// Whether a key says something of the fluid alone.
bool is_of_fluid(std::string_view path);

/// The keys that a scene has: of the table as far as they apply to it (without a domain none of the fluid's),
/// then of its entries.
std::vector<SceneKey> keys_of(const Scene& scene);

} // namespace undula::fom
