#include "fom/output/last_periods.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace undula::fom {

LastPeriods last_periods(const CycleMeans& cycles, const std::string& column) {
  constexpr std::size_t looked_at = 3;
  const auto means = period_means(cycles, column);
  const auto [low, high] = std::ranges::minmax(std::span(means).last(std::min(means.size(), looked_at)));
  return {means.back(), high - low};
}

} // namespace undula::fom
