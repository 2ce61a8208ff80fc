// What a part of some values is within.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace undula::training {

inline constexpr double nine_in_ten = 0.9;

/// The smallest of the values that `part` of them do not exceed; at least one value.
inline double quantile(std::vector<double> values, double part) {
  std::ranges::sort(values);
  const auto place = static_cast<std::size_t>(std::ceil(part * static_cast<double>(values.size())));
  return values[std::min(values.size(), std::max<std::size_t>(place, 1)) - 1];
}

} // namespace undula::training
