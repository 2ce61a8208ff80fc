#include "apps/input/head_list.hpp"

#include <charconv>
#include <cmath>

#include "rom/base/error.hpp"

namespace undula::apps {
namespace {

struct Reader {
  const std::string& text;
  const NumberList& list;

  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(std::string("the list of ") + list.noun + " cannot be read: " + what, '"' + text + '"',
                     std::string(list.noun) + " in " + list.unit +
                         ", low:high:step or values with commas, for instance " + list.example,
                     list.option);
  }

  double number(const std::string& part) const {
    double value = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (part.empty() || error != std::errc() || end != part.data() + part.size() || !std::isfinite(value)) {
      refuse('"' + part + "\" is not a number");
    }
    return value;
  }
};

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

} // namespace

std::vector<double> parse_heads(const std::string& text) {
  return parse_numbers(text, {"heads", "mmHg", "40:62:2 or 50,55,60", "--head"});
}

std::vector<double> parse_numbers(const std::string& text, const NumberList& list) {
  constexpr std::size_t most = 10000;
  const Reader read{text, list};
  const std::string too_many = std::string("more than 10000 ") + list.noun;
  std::vector<double> numbers;
  for (const std::string& entry : split(text, ',')) {
    const auto parts = split(entry, ':');
    if (parts.size() == 1) {
      numbers.push_back(read.number(parts[0]));
      continue;
    }
    if (parts.size() != 3) {
      read.refuse("a range has three numbers");
    }
    const double low = read.number(parts[0]);
    const double high = read.number(parts[1]);
    const double step = read.number(parts[2]);
    if (step == 0 || (high - low) / step < 0) {
      read.refuse("the step does not lead from the first to the last");
    }
    const double steps = std::floor((high - low) / step + 1e-9);
    if (steps >= static_cast<double>(most)) {
      read.refuse(too_many);
    }
    for (int i = 0; i <= static_cast<int>(steps); ++i) {
      numbers.push_back(low + i * step);
    }
  }
  if (numbers.size() > most) {
    read.refuse(too_many);
  }
  return numbers;
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
