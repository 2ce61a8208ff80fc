#include "fom/output/scene_difference.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "fom/scene/entry_table.hpp"
#include "fom/scene/scene_file.hpp"

namespace undula::fom {
namespace {

/// "0.53" of "{ value = 0.53, tolerance = 0.02 }": a tolerance is no part of the state.
std::string without_tolerance(const std::string& value) {
  const std::string begin = "{ value = ";
  if (!value.starts_with(begin)) return value;
  return value.substr(begin.size(), value.find(',') - begin.size());
}

/// Values by path. The text is one that scene_to_toml wrote: a key per line.
std::map<std::string, std::string> keys_in(const std::string& text) {
  std::map<std::string, std::string> keys;
  std::istringstream lines(text);
  std::string section;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('[') && line.ends_with(']')) {
      section = line.substr(1, line.size() - 2) + ".";
      continue;
    }
    const auto equals = line.find(" = ");
    if (line.starts_with('#') || equals == std::string::npos) continue;
    keys[section + line.substr(0, equals)] = without_tolerance(line.substr(equals + 3));
  }
  return keys;
}

bool names_a_file(const std::string& path) {
  return path == "geometry.profile" || path == "geometry.fluid_mesh" || path == "geometry.solid_meshes";
}

} // namespace

std::vector<KeyDifference> differing_keys(const std::string& text_before, const std::string& text_now) {
  const auto before = keys_in(text_before), now = keys_in(text_now);
  std::set<std::string> paths;
  for (const auto* keys : {&before, &now})
    for (const auto& [path, value] : *keys) paths.insert(path);
  std::vector<KeyDifference> differences;
  for (const auto& path : paths) {
    const auto was = before.find(path), is = now.find(path);
    if (names_a_file(path) || (was != before.end() && is != now.end() && was->second == is->second)) continue;
    differences.push_back(
        {path, was == before.end() ? "nothing" : was->second, is == now.end() ? "nothing" : is->second});
  }
  return differences;
}

std::string recorded_value(const std::string& text, const std::string& key) {
  const auto keys = keys_in(text);
  const auto found = keys.find(key);
  return found == keys.end() ? "" : found->second;
}

std::string difference_text(const std::vector<KeyDifference>& differences) {
  constexpr std::size_t told = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(told, differences.size()); ++i)
    text += (i == 0 ? "" : "; ") + differences[i].key + ": was " + differences[i].was + ", is " +
            differences[i].is;
  if (differences.size() > told) text += "; and " + std::to_string(differences.size() - told) + " more";
  return text.empty() ? "the content of a file that the scene names" : text;
}

std::string difference_text(const std::string& text_before, const Scene& scene) {
  std::set<std::string> free;
  for (const SceneKey& key : keys_of(scene))
    if (!key.shapes_state) free.insert(key.path);
  auto differences = differing_keys(text_before, scene_to_toml(scene));
  std::erase_if(differences, [&](const KeyDifference& one) { return free.contains(one.key); });
  return difference_text(differences);
}

} // namespace undula::fom
