#include "fom/output/last_periods.hpp"

#include <algorithm>

namespace undula::fom {

LastPeriods last_periods(const CycleMeans& cycles, const std::string& column) {
  constexpr std::size_t looked_at = 3;
  const auto place = static_cast<std::size_t>(
      std::find(cycles.columns.begin(), cycles.columns.end(), column) - cycles.columns.begin());
  const std::size_t periods = cycles.periods.size();
  const auto mean = [&](std::size_t period) { return cycles.mean[period * cycles.columns.size() + place]; };
  LastPeriods last{mean(periods - 1), 0};
  double low = last.mean, high = last.mean;
  for (std::size_t period = periods - std::min(periods, looked_at); period < periods; ++period) {
    low = std::min(low, mean(period));
    high = std::max(high, mean(period));
  }
  last.spread = high - low;
  return last;
}

} // namespace undula::fom
