#include "fom/scene/scene_key_search.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "fom/scene/entry_table.hpp"

namespace undula::fom {
namespace {

std::string_view leaf_of(std::string_view path) {
  const auto dot = path.rfind('.');
  return dot == std::string_view::npos ? path : path.substr(dot + 1);
}

/// Ends of key names that people use for units, besides those of the table.
constexpr std::array foreign_units = {
    "um",        "mm",       "cm",       "m",        "inch",  "us",      "ms",  "s",           "min",
    "Hz",        "hz",       "kHz",      "rpm",      "rad_s", "Pa",      "kPa", "MPa",         "GPa",
    "hPa",       "bar",      "mbar",     "mmHg",     "mmhg",  "psi",     "dyn", "dyn_per_cm2", "kg_per_m3",
    "g_per_cm3", "g_cm3",    "kg_m3",    "g_per_ml", "Pa_s",  "mPa_s",   "cP",  "poise",       "centipoise",
    "m_per_s",   "cm_per_s", "mm_per_s", "m_s",      "cm_s",  "N_per_m2"};

bool is_unit(std::string_view text) {
  return std::find(foreign_units.begin(), foreign_units.end(), text) != foreign_units.end();
}

/// The keys a path may mean: those of its entry, [body.flag], or of the table.
std::span<const SceneKey> keys_around(std::string_view path) {
  const EntryName entry = entry_of(path);
  return entry ? entry_keys(entry.kind, entry.name) : scene_table();
}

/// The nearest of the keys that `counts` accepts.
template <typename Counts>
const SceneKey& nearest_among(std::string_view path, const Counts& counts) {
  const SceneKey* nearest = nullptr;
  int least = std::numeric_limits<int>::max();
  for (const SceneKey& key : keys_around(path)) {
    // One more than the leaves' distance, so that a key of the section at hand is preferred.
    const int elsewhere = edit_distance(leaf_of(path), leaf_of(key.path)) + 1;
    int distance = std::min(edit_distance(path, key.path), elsewhere);
    if (!key.unit.empty()) {
      // Misspelt and without its unit: a unit is longer than most other keys are far away.
      const auto quantity = std::string_view(key.path).substr(0, key.path.size() - key.unit.size() - 1);
      distance = std::min(distance, edit_distance(path, quantity) + 1);
    }
    if (distance < least && counts(key)) {
      least = distance;
      nearest = &key;
    }
  }
  // An entry may have none that counts.
  return nearest != nullptr || !entry_of(path) ? *nearest : nearest_among(leaf_of(path), counts);
}

} // namespace

int edit_distance(std::string_view a, std::string_view b) {
  std::vector<int> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) {
    row[j] = static_cast<int>(j);
  }
  for (std::size_t i = 1; i <= a.size(); ++i) {
    int diagonal = row[0];
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

const SceneKey* find_key(std::string_view path) {
  const auto table = keys_around(path);
  const auto found =
      std::find_if(table.begin(), table.end(), [&](const SceneKey& key) { return key.path == path; });
  return found == table.end() ? nullptr : &*found;
}

const SceneKey* same_quantity(std::string_view path) {
  for (const SceneKey& key : keys_around(path)) {
    if (key.unit.empty()) {
      continue;
    }
    const std::string_view quantity =
        std::string_view(key.path).substr(0, key.path.size() - key.unit.size() - 1);
    if (path == quantity || (path.starts_with(quantity) && path[quantity.size()] == '_' &&
                             is_unit(path.substr(quantity.size() + 1)))) {
      return &key;
    }
  }
  return nullptr;
}

const SceneKey& nearest_key(std::string_view path) {
  return nearest_among(path, [](const SceneKey&) { return true; });
}

const SceneKey& nearest_real_key(std::string_view path) {
  return nearest_among(path, [](const SceneKey& key) { return std::holds_alternative<RealKey>(key.value); });
}

bool is_section(std::string_view name) {
  const auto table = scene_table();
  return !name.empty() &&
         std::any_of(table.begin(), table.end(), [&](const SceneKey& key) { return key.section() == name; });
}

} // namespace undula::fom
