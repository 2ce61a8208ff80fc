#include "fom/scene/hose_checks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "fom/scene/key_place.hpp"
#include "fom/scene/scene_key_search.hpp"
#include "fom/scene/scene_table.hpp"
#include "fom/scene/scene_value.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::fom {
namespace {

std::string mm(double length) { return plain_number(units::length_to_mm(length)) + " mm"; }

/// Keys of any scene that the flow along a hose reads.
bool is_read(const SceneKey& key) {
  constexpr std::array<std::string_view, 2> any = {"name", "model.space"};
  return key.scope != Scope::any || key.section() == "fluid" || key.section() == "output" ||
         std::ranges::find(any, key.path) != any.end();
}

/// Whether a key has its default, as it has in a resolved scene.
bool has_default(const SceneKey& key, const Scene& scene) {
  Scene copy = scene; // the accessors of the table give mutable references
  if (const auto* real = std::get_if<RealKey>(&key.value))
    return real->fallback && real->field(copy) == *real->fallback * real->cgs_per_unit;
  if (const auto* integer = std::get_if<IntegerKey>(&key.value))
    return integer->fallback && integer->field(copy) == *integer->fallback;
  const auto* choice = std::get_if<ChoiceKey>(&key.value);
  if (choice == nullptr) return false;
  return std::ranges::any_of(choice->available, [&](const auto& one) {
    return one.first == choice->fallback && one.second == choice->get(copy);
  });
}

/// What is stated and would be left out is refused.
void check_keys(const Scene& scene) {
  for (const auto& [path, place] : scene.places) {
    const SceneKey* key = find_key(path);
    if (key == nullptr) continue;
    if (!key->applies_to(scene))
      throw InputError("key \"" + path + "\" does not apply to this scene", "a scene of a peristaltic pump",
                       scope_text(key->scope), place);
    if (!is_read(*key) && !has_default(*key, scene))
      throw InputError("key \"" + path + "\" means nothing to space = \"long-wave\"",
                       "another value than its default", "no such key, or " + default_text(*key), place);
  }
}

void check_rollers(const geometry::RollerTrack& track, const std::string& at) {
  const double bore = 2 * track.bore_radius;
  if (track.gap >= bore)
    throw InputError("the film is as high as the bore", "film " + mm(track.gap) + ", bore " + mm(bore),
                     "\"rollers.film_mm\" < \"hose.bore_mm\"", at);
  if (!(geometry::pressing_radius(track) > track.roller_radius))
    throw InputError("the rollers do not fit between the rotor's axis and the hose",
                     "a roller of radius " + mm(track.roller_radius) + ", pressing to radius " +
                         mm(geometry::pressing_radius(track)),
                     "\"rollers.radius_mm\" below track_radius - 2 wall - height of the squeezed bore", at);
  if (!(geometry::crank(track) > bore - track.gap))
    throw InputError(
        "the rollers never leave the hose: they turn on too small a circle",
        "their axes at radius " + mm(geometry::crank(track)) + ", to lift by " + mm(bore - track.gap),
        "a larger \"rollers.track_radius_mm\", or smaller rollers", at);
  const double apart = 2 * geometry::crank(track) * std::sin(std::numbers::pi / track.rollers);
  if (track.rollers > 1 && apart <= 2 * track.roller_radius)
    throw InputError("the rollers overlap on their rotor",
                     mm(apart) + " between neighbouring axes, radius " + mm(track.roller_radius),
                     "fewer or smaller rollers", at);
  const double spacing = 2 * std::numbers::pi * geometry::centreline_radius(track) / track.rollers;
  if (const double squeezed = 2 * geometry::half_reach(track, track.gap); squeezed > spacing)
    throw InputError("neighbouring rollers squeeze the same piece of hose",
                     mm(squeezed) + " squeezed by each, " + mm(spacing) + " apart",
                     "fewer or smaller rollers, or a larger track", at);
}

void check_ends(const Scene& scene, const geometry::RollerTrack& track, const std::string& where) {
  const double reach = geometry::outer_reach(track);
  for (const auto& [key, length] : {std::pair("hose.inlet_length_mm", scene.hose.inlet_length),
                                    std::pair("hose.outlet_length_mm", scene.hose.outlet_length)})
    if (length < reach)
      throw InputError("an end of the hose is squeezed by a roller that leaves the track", mm(length),
                       "at least " + mm(reach), place_of_key(scene, key, where));
}

} // namespace

geometry::RollerTrack roller_track(const Scene& scene) {
  const HoseSettings& hose = scene.hose;
  const RollerSettings& rollers = scene.rollers;
  return {hose.bore / 2,
          hose.wall,
          rollers.track_radius,
          rollers.track_angle,
          rollers.radius,
          rollers.count,
          std::max((1 - rollers.occlusion) * hose.bore, rollers.film)};
}

void check_peristaltic_pump(const Scene& scene, const std::string& where) {
  if (scene.space != Space::long_wave)
    throw InputError("a peristaltic pump is computed by its fast level alone in this version",
                     "another \"model.space\"", "space = \"long-wave\"",
                     place_of_key(scene, "model.space", where));
  check_keys(scene);
  const geometry::RollerTrack track = roller_track(scene);
  check_rollers(track, where + ", section [rollers]");
  check_ends(scene, track, where);
}

} // namespace undula::fom
