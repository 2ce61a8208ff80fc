#include "training/sampling/key_range.hpp"

#include <charconv>
#include <cmath>

namespace undula::training {

std::optional<double> read_finite(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<KeyRange> read_key_range(std::string_view text) {
  const auto equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0) return std::nullopt;
  const auto colon = text.find(':', equals);
  if (colon == std::string_view::npos) return std::nullopt;
  const auto low = read_finite(text.substr(equals + 1, colon - equals - 1));
  const auto high = read_finite(text.substr(colon + 1));
  if (!low || !high) return std::nullopt;
  return KeyRange{std::string(text.substr(0, equals)), *low, *high};
}

} // namespace undula::training
