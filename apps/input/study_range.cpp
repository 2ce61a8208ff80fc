#include "apps/input/study_range.hpp"

#include <charconv>
#include <cmath>
#include <string_view>
#include <variant>

#include "fom/scene/scene_key_search.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"

namespace undula::apps {
namespace {

/// The parts of a text between colons.
std::vector<std::string_view> between_colons(std::string_view text) {
  std::vector<std::string_view> parts;
  for (;;) {
    const auto colon = text.find(':');
    parts.push_back(text.substr(0, colon));
    if (colon == std::string_view::npos) {
      return parts;
    }
    text.remove_prefix(colon + 1);
  }
}

template <typename Number>
bool read_all(std::string_view text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

} // namespace

StudyRange parse_study_range(const std::string& text) {
  StudyRange range;
  const auto equals = text.find('=');
  const auto parts =
      between_colons(std::string_view(text).substr(equals == std::string::npos ? text.size() : equals + 1));
  range.key = text.substr(0, equals);
  const bool counted = parts.size() == 3;
  if (equals == std::string::npos || equals == 0 || (parts.size() != 2 && !counted) ||
      !read_all(parts[0], range.low) || !read_all(parts[1], range.high) || !std::isfinite(range.low) ||
      !std::isfinite(range.high) || (counted && (!read_all(parts[2], range.count) || range.count < 2))) {
    throw InputError("a range of a study cannot be read", '"' + text + '"',
                     "section.key=low:high or section.key=low:high:count with a count of 2 or more, for "
                     "instance hose.bore_mm=24:40:5",
                     "--vary");
  }
  return range;
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
