#include "fom/scene/scene_value.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "fom/scene/entry_table.hpp"
#include "fom/scene/scene_checks.hpp"
#include "fom/scene/scene_key_search.hpp"
#include "rom/base/error.hpp"

namespace undula::fom {
namespace {

std::string name_of(const Scene& scene) {
  return scene.file.empty() ? "scene \"" + scene.name + '"' : scene.file.string();
}

const SceneKey& real_key(const Scene& scene, std::string_view path) {
  check_entry_exists(scene, path, name_of(scene));
  const SceneKey* key = find_key(path);
  if (key != nullptr && std::holds_alternative<RealKey>(key->value)) {
    return *key;
  }
  const SceneKey* other_unit = same_quantity(path);
  const bool is_real = other_unit != nullptr && std::holds_alternative<RealKey>(other_unit->value);
  const SceneKey& meant = is_real ? *other_unit : nearest_real_key(path);
  throw InputError(key == nullptr ? "unknown key of a scene" : "this key of a scene holds no real number",
                   '"' + std::string(path) + '"',
                   "the nearest key with a real number is \"" + meant.path + '"', name_of(scene));
}

} // namespace

double to_surface_unit(double stored, double cgs_per_unit) {
  const double guess = stored / cgs_per_unit;
  char text[40];
  for (int digits = 1; digits <= 17; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, guess);
    const double candidate = std::strtod(text, nullptr);
    if (candidate * cgs_per_unit == stored) {
      return candidate;
    }
  }
  // The quotient may be off by a rounding or two.
  double below = guess;
  double above = guess;
  for (int ulp = 0; ulp < 4; ++ulp) {
    below = std::nextafter(below, -HUGE_VAL);
    above = std::nextafter(above, HUGE_VAL);
    for (const double candidate : {below, above}) {
      if (candidate * cgs_per_unit == stored) {
        return candidate;
      }
    }
  }
  return guess;
}

double surface_value(const Scene& scene, std::string_view key) {
  const auto& real = std::get<RealKey>(real_key(scene, key).value);
  Scene copy = scene; // the accessors of the table give mutable references
  return to_surface_unit(real.field(copy), real.cgs_per_unit);
}

void set_value(Scene& scene, std::string_view key, double surface_value) {
  const SceneKey& found = real_key(scene, key);
  const auto& real = std::get<RealKey>(found.value);
  if (!real.allowed.contains(surface_value)) { // refuses nan as well
    throw InputError("key \"" + found.path + "\" is out of range", shortest_number(surface_value),
                     allowed_text(found), name_of(scene));
  }
  real.field(scene) = surface_value * real.cgs_per_unit;
}

Scene with_value(const Scene& scene, std::string_view key, double surface_value) {
  Scene changed = scene;
  set_value(changed, key, surface_value);
  check_consistency(changed, name_of(scene));
  return changed;
}

} // namespace undula::fom
