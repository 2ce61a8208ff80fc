#include "apps/input/head_list.hpp"

#include <charconv>
#include <cmath>

#include "rom/base/error.hpp"

namespace undula::apps {
namespace {

[[noreturn]] void refuse(const std::string& text, const std::string& what) {
  throw InputError("the list of heads cannot be read: " + what, '"' + text + '"',
                   "heads in mmHg, low:high:step or values with commas, for instance 40:62:2 or 50,55,60",
                   "--head");
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

double number(const std::string& part, const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
  if (part.empty() || error != std::errc() || end != part.data() + part.size() || !std::isfinite(value)) {
    refuse(text, '"' + part + "\" is not a number");
  }
  return value;
}

} // namespace

std::vector<double> parse_heads(const std::string& text) {
  constexpr std::size_t most_heads = 10000;
  std::vector<double> heads;
  for (const std::string& entry : split(text, ',')) {
    const auto parts = split(entry, ':');
    if (parts.size() == 1) {
      heads.push_back(number(parts[0], text));
      continue;
    }
    if (parts.size() != 3) {
      refuse(text, "a range has three numbers");
    }
    const double low = number(parts[0], text);
    const double high = number(parts[1], text);
    const double step = number(parts[2], text);
    if (step == 0 || (high - low) / step < 0) {
      refuse(text, "the step does not lead from the first to the last head");
    }
    const double steps = std::floor((high - low) / step + 1e-9);
    if (steps >= static_cast<double>(most_heads)) {
      refuse(text, "more than 10000 heads");
    }
    for (int i = 0; i <= static_cast<int>(steps); ++i) {
      heads.push_back(low + i * step);
    }
  }
  if (heads.size() > most_heads) {
    refuse(text, "more than 10000 heads");
  }
  return heads;
}

std::vector<double> even_heads(double low, double high, int count) {
  if (count == 1) {
    return {(low + high) / 2};
  }
  std::vector<double> heads(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    heads[static_cast<std::size_t>(i)] = low + (high - low) * i / (count - 1);
  }
  return heads;
}

} // namespace undula::apps
