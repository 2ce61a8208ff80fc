#include "fom/output/settled_mean.hpp"

#include <algorithm>
#include <cmath>

namespace undula::fom {
namespace {

double mean_of(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Sum of the products of deviations from the mean, `lag` places apart.
double covariance_sum(std::span<const double> values, double mean, std::size_t lag) {
  double sum = 0;
  for (std::size_t i = lag; i < values.size(); ++i) sum += (values[i] - mean) * (values[i - lag] - mean);
  return sum;
}

/// Squared, as if the values were independent.
double variance_of_mean(std::span<const double> values) {
  const auto count = static_cast<double>(values.size());
  return covariance_sum(values, mean_of(values), 0) / ((count - 1) * count);
}

} // namespace

SettledMean settled_mean(std::span<const double> values) {
  constexpr std::size_t fewest = 3;
  constexpr double strongest = 0.9;
  SettledMean settled;
  if (values.empty()) return settled;
  if (values.size() < fewest) {
    settled.mean = values.back();
    settled.counted = 1;
    return settled;
  }
  const std::size_t least = std::max(fewest, (values.size() + 1) / 2);
  auto counted = values;
  for (auto rest = values; rest.size() >= least; rest = rest.subspan(1))
    if (variance_of_mean(rest) < variance_of_mean(counted)) counted = rest;
  const auto count = static_cast<double>(counted.size());
  const auto [low, high] = std::ranges::minmax(counted);
  settled.mean = mean_of(counted);
  settled.spread = high - low;
  settled.counted = static_cast<int>(counted.size());
  const double squares = covariance_sum(counted, settled.mean, 0);
  const double neighbours =
      squares > 0 ? covariance_sum(counted, settled.mean, 1) / squares + 1 / count : 0.0;
  const double correlation = std::clamp(neighbours, 0.0, strongest);
  settled.standard_error = std::sqrt(variance_of_mean(counted) * (1 + correlation) / (1 - correlation));
  return settled;
}

} // namespace undula::fom
