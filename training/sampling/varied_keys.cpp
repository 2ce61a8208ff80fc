#include "training/sampling/varied_keys.hpp"

#include <algorithm>

#include "fom/scene/scene_key_search.hpp"
#include "fom/scene/scene_value.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "training/sampling/key_range.hpp"

namespace undula::training {
namespace {

constexpr const char* where = "training.vary";

VariedKey parsed(const std::string& text) {
  const auto range = read_key_range(text);
  if (!range)
    throw InputError("a varied key cannot be read", '"' + text + '"',
                     "section.key=low:high, for instance membrane.young_dyn_per_cm2=1.5e7:1.9e7", where);
  return {range->key, {}, range->low, range->high};
}

} // namespace

std::vector<VariedKey> varied_keys(const Scene& scene) {
  std::vector<VariedKey> keys;
  if (scene.training.vary.empty()) return keys;
  if (scene.training.model != ModelKind::emulator)
    throw InputError("a projected model varies no further keys", '"' + scene.training.vary.front() + '"',
                     "training.model = \"emulator\", or no training.vary", where);
  for (const auto& text : scene.training.vary) {
    auto key = parsed(text);
    key.stated = surface_value(scene, key.key); // refuses what is no real-valued key
    key.unit = find_key(key.key)->unit;
    if (key.key.starts_with("operating_point.") || key.key.starts_with("training."))
      throw InputError("this key has a range of its own", '"' + key.key + '"',
                       "training.frequency_low_Hz and its like", where);
    if (std::ranges::any_of(keys, [&](const VariedKey& other) { return other.key == key.key; }))
      throw InputError("a key is varied twice", '"' + key.key + '"', "every key once", where);
    if (!(key.low < key.high))
      throw InputError("a varied key has no range", exact_number(key.low) + ":" + exact_number(key.high),
                       "low:high with low < high", where);
    with_value(scene, key.key, key.low); // refuse values out of the key's own range
    with_value(scene, key.key, key.high);
    if (key.stated < key.low || key.stated > key.high)
      throw InputError("the scene is outside of the range of a key that it varies",
                       key.key + " = " + exact_number(key.stated),
                       "a value in " + exact_number(key.low) + ":" + exact_number(key.high), where);
    keys.push_back(std::move(key));
  }
  return keys;
}

Scene at_point(const Scene& scene, const OperatingPoint& point) {
  Scene changed = scene;
  for (const auto& [key, value] : point.varied) changed = with_value(changed, key, value);
  changed.operating_point = point;
  return changed;
}

} // namespace undula::training
