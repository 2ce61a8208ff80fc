// Scene files: TOML read and written through the table of scene_table.hpp.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fom/scene/scene.hpp"

namespace undula::fom {

/// Reads a scene file, fills in the defaults, applies `overrides` ("section.key=value", as given to `--set`,
/// later ones win) and checks everything that needs no other file than the scene. Relative paths in the file
/// start at its folder, those in an override at the working directory; the returned scene holds absolute
/// paths. Throws InputError naming file and line for bad TOML, unknown keys (with the nearest valid one),
/// wrong units, types and values, values planned but not available, missing keys and files, and
/// contradictions between keys. A real number may stand as { value = ..., tolerance = ... }, which fills
/// Scene::tolerances; an override by a bare number keeps the tolerance, one by such a table replaces it.
Scene read_scene(const std::filesystem::path& file, std::span<const std::string> overrides = {});

/// The same for a scene held as text, for instance one recorded in an output file. `origin` names it in
/// messages, relative paths start at `base`. Scene::file stays empty.
Scene parse_scene(std::string_view text, const std::string& origin, const std::filesystem::path& base,
                  std::span<const std::string> overrides = {});

/// The resolved scene as TOML: every key with its value in force. parse_scene gives the same scene back, bit
/// for bit for every scene that was itself read from TOML; values set in code that no decimal in the surface
/// unit converts to are written with the nearest one.
std::string scene_to_toml(const Scene& scene);

/// 16 hexadecimal digits that change when a key that shapes the computed state changes, or the content of the
/// profile or of a mesh. Name, length of the run, output, training and tolerances do not count, so that a run
/// can be prolonged from a checkpoint.
std::string scene_hash(const Scene& scene);

} // namespace undula::fom
