#include "apps/input/study_range.hpp"

#include <charconv>
#include <cmath>
#include <string_view>
#include <variant>

#include "fom/scene/scene_key_search.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "training/sampling/key_range.hpp"

namespace undula::apps {
namespace {

bool read_count(std::string_view text, int& count) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  return error == std::errc() && end == text.data() + text.size() && count >= 2;
}

} // namespace

StudyRange parse_study_range(const std::string& text) {
  const auto equals = text.find('=');
  const auto first = text.find(':', equals == std::string::npos ? 0 : equals), last = text.rfind(':');
  const bool counted = first != std::string::npos && last > first;
  const auto range = read_key_range(counted ? std::string_view(text).substr(0, last) : text);
  int count = 0;
  if (!range || (counted && !read_count(std::string_view(text).substr(last + 1), count))) {
    throw InputError("a range of a study cannot be read", '"' + text + '"',
                     "section.key=low:high or section.key=low:high:count with a count of 2 or more, for "
                     "instance hose.bore_mm=24:40:5",
                     "--vary");
  }
  StudyRange result;
  result.key = range->key, result.low = range->low, result.high = range->high, result.count = count;
  return result;
}

std::vector<std::string> overrides_of(std::vector<std::string> overrides,
                                      const std::vector<std::string>& keys,
                                      const std::vector<double>& values) {
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const SceneKey* key = find_key(keys[i]);
    const bool whole = key != nullptr && std::holds_alternative<IntegerKey>(key->value);
    overrides.push_back(keys[i] + "=" +
                        (whole ? std::to_string(std::llround(values[i])) : exact_number(values[i])));
  }
  return overrides;
}

} // namespace undula::apps
