#include "training/study/study_plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "fom/scene/entry_table.hpp"
#include "fom/scene/scene_key_search.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "training/sampling/scrambled_halton.hpp"

namespace undula::training {
namespace {

std::string where(const StudyRange& range) { return "--vary " + range.key; }

/// A value of a full plan: the ends as they are stated, those between them without the last digits, so that
/// 0.7 to 1 holds 0.8 and not 0.7999999999999999.
double value_of(const StudyRange& range, int i) {
  if (i == 0) return range.low;
  if (i == range.count - 1) return range.high;
  char text[32];
  std::snprintf(text, sizeof text, "%.12g", range.low + (range.high - range.low) * i / (range.count - 1));
  return std::strtod(text, nullptr);
}

void check_key(const Scene& scene, const StudyRange& range) {
  check_entry_exists(scene, range.key, where(range));
  const SceneKey* key = find_key(range.key);
  if (key == nullptr) {
    const SceneKey* meant = same_quantity(range.key);
    throw InputError(
        "a study varies an unknown key", '"' + range.key + '"',
        "the nearest valid key is \"" + (meant != nullptr ? *meant : nearest_key(range.key)).path + '"',
        where(range));
  }
  if (!key->applies_to(scene))
    throw InputError("a study varies a key that does not apply to its scene", '"' + range.key + '"',
                     scope_text(key->scope), where(range));
  const auto* real = std::get_if<RealKey>(&key->value);
  const auto* integer = std::get_if<IntegerKey>(&key->value);
  if (real == nullptr && integer == nullptr)
    throw InputError("a study varies a key that is no number", '"' + range.key + '"',
                     "a key with a number; other choices are a study each", where(range));
  for (const double end : {range.low, range.high})
    if (real != nullptr ? !real->allowed.contains(end) : !(end >= integer->low && end <= integer->high))
      throw InputError("a study leaves the range of a key", exact_number(end), allowed_text(*key),
                       where(range));
  if (integer == nullptr) return;
  for (int i = 0; i < range.count; ++i)
    if (const double value = value_of(range, i); value != std::floor(value))
      throw InputError("a study gives a whole-number key other values", exact_number(value),
                       allowed_text(*key) + ": low, high and count that give such", where(range));
  if (range.count == 0)
    throw InputError("a whole-number key is in no space-filling plan", '"' + range.key + '"',
                     "a full plan, --vary KEY=low:high:count for every key", where(range));
}

void check_ranges(const Scene& scene, std::span<const StudyRange> ranges) {
  if (ranges.empty() || ranges.size() > most_study_keys)
    throw InputError("a study varies too few or too many keys", std::to_string(ranges.size()) + " keys",
                     "1 to " + std::to_string(most_study_keys) + " times --vary", "--vary");
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const StudyRange& range = ranges[i];
    for (std::size_t k = 0; k < i; ++k)
      if (ranges[k].key == range.key)
        throw InputError("a study varies a key twice", '"' + range.key + '"', "one --vary per key",
                         where(range));
    if (!(range.low < range.high))
      throw InputError("a range of a study is empty",
                       exact_number(range.low) + " to " + exact_number(range.high), "low < high",
                       where(range));
    if (range.count == 1 || range.count < 0)
      throw InputError("a range of a study has too few values", std::to_string(range.count),
                       "two or more, its ends", where(range));
    if ((range.count == 0) != (ranges.front().count == 0))
      throw InputError(
          "a plan is neither full nor space-filling", "a count of values for some keys and none for others",
          "--vary KEY=low:high:count for every key, or low:high for every key with --points", where(range));
    check_key(scene, range);
  }
}

std::vector<std::vector<double>> full_plan(std::span<const StudyRange> ranges) {
  double runs = 1;
  for (const StudyRange& range : ranges) runs *= range.count;
  if (runs > most_study_runs)
    throw InputError("a full plan has too many runs", plain_number(runs),
                     "at most " + std::to_string(most_study_runs) +
                         "; fewer values, or a space-filling plan with --points",
                     "--vary");
  std::vector<std::vector<double>> points = {{}};
  for (const StudyRange& range : ranges) {
    std::vector<std::vector<double>> longer;
    for (const auto& point : points)
      for (int i = 0; i < range.count; ++i) {
        longer.push_back(point);
        longer.back().push_back(value_of(range, i));
      }
    points = std::move(longer);
  }
  return points;
}

} // namespace

StudyPlan plan_study(const Scene& scene, std::span<const StudyRange> ranges, int points) {
  check_ranges(scene, ranges);
  StudyPlan plan;
  for (const StudyRange& range : ranges) plan.keys.push_back(range.key);
  plan.full = ranges.front().count > 0;
  if (plan.full) {
    plan.points = full_plan(ranges);
    return plan;
  }
  if (points < 1 || points > most_study_runs)
    throw InputError("a space-filling plan has too few or too many points", std::to_string(points),
                     "1 to " + std::to_string(most_study_runs), "--points");
  const ScrambledHalton halton(7, static_cast<int>(ranges.size()));
  for (int k = 1; k <= points; ++k) {
    auto point = halton(k);
    for (std::size_t i = 0; i < ranges.size(); ++i)
      point[i] = std::min(ranges[i].high, ranges[i].low + point[i] * (ranges[i].high - ranges[i].low));
    plan.points.push_back(std::move(point));
  }
  return plan;
}

} // namespace undula::training
