#include "fom/scene/scene_tolerance.hpp"

#include <algorithm>

#include "fom/scene/scene_key_search.hpp"
#include "fom/scene/scene_table.hpp"
#include "fom/scene/scene_value.hpp"

namespace undula::fom {
namespace {

std::size_t place_in_table(std::string_view path) {
  const auto table = scene_table();
  return static_cast<std::size_t>(
      std::find_if(table.begin(), table.end(), [&](const SceneKey& key) { return key.path == path; }) -
      table.begin());
}

} // namespace

double tolerance_of(const Scene& scene, std::string_view key) {
  for (const Tolerance& stated : scene.tolerances) {
    if (stated.key == key) {
      return stated.tolerance;
    }
  }
  return 0;
}

void set_tolerance(Scene& scene, const std::string& key, double tolerance) {
  auto& all = scene.tolerances;
  std::erase_if(all, [&](const Tolerance& stated) { return stated.key == key; });
  if (tolerance == 0) {
    return;
  }
  const std::size_t place = place_in_table(key);
  const auto next = std::find_if(all.begin(), all.end(),
                                 [&](const Tolerance& stated) { return place_in_table(stated.key) > place; });
  all.insert(next, Tolerance{key, tolerance});
}

void narrow_tolerance(Scene& scene, const std::string& key) {
  const double value = surface_value(scene, key);
  const AllowedRange& allowed = std::get<RealKey>(find_key(key)->value).allowed;
  double tolerance = std::min({tolerance_of(scene, key), value - allowed.low, allowed.high - value});
  // An open end itself is refused.
  if (tolerance > 0 && !(allowed.contains(value - tolerance) && allowed.contains(value + tolerance)))
    tolerance *= 1 - 1e-6;
  set_tolerance(scene, key, std::max(tolerance, 0.0));
}

} // namespace undula::fom
