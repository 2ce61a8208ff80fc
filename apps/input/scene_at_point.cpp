#include "apps/input/scene_at_point.hpp"

#include <regex>
#include <sstream>

#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"

namespace undula::apps {
namespace {

constexpr const char* section = "[operating_point]";

/// A number as TOML takes it for a key of reals.
std::string toml_number(double value) {
  const std::string text = exact_number(value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

} // namespace

std::string scene_at_point(const std::string& scene, const std::map<std::string, double>& values) {
  auto left = values;
  std::string result, inserted;
  std::size_t after_header = std::string::npos;
  bool inside = false;
  std::istringstream lines(scene);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('[')) {
      inside = line == section;
    } else if (inside) {
      // "key = 0.5" and "key = { value = 0.5, tolerance = 0.01 }"
      static const std::regex number(R"(^(\w+)( = (?:\{ *value = )?)([-+.\w]+)(.*)$)");
      std::smatch parts;
      if (std::regex_match(line, parts, number)) {
        if (const auto found = left.find(parts[1]); found != left.end()) {
          line = parts[1].str() + parts[2].str() + toml_number(found->second) + parts[4].str();
          left.erase(found);
        }
      }
    }
    result += line + "\n";
    if (inside && after_header == std::string::npos) {
      after_header = result.size();
    }
  }
  if (after_header == std::string::npos) {
    throw InputError("the scene states no operating point", "no section " + std::string(section),
                     "the scene of a pump", "the model's provenance");
  }
  for (const auto& [key, value] : left) {
    inserted += key + " = " + toml_number(value) + "\n";
  }
  return result.insert(after_header, inserted);
}

} // namespace undula::apps
