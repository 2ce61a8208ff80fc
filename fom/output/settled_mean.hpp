// The mean of a signal that settles and then keeps fluctuating, and how well it is known.
#pragma once

#include <limits>
#include <span>

namespace undula::fom {

/// In the unit of the values.
struct SettledMean {
  double mean = 0;
  /// Of the mean; NaN: too few values.
  double standard_error = std::numeric_limits<double>::quiet_NaN();
  double spread = 0; ///< largest minus smallest value that counts
  int counted = 0;   ///< values that count: the last ones
};

/// The first values are left out as the transient: as many as make the variance of the mean of the others
/// least (White 1997, marginal standard error rule), but at least half of all and three count.
///
/// The standard error takes the values as a first-order autoregressive sequence:
///   s / sqrt(m) * sqrt((1 + r) / (1 - r)),
/// r the correlation of neighbours, corrected for its bias 1 / m and within [0, 0.9]. Two values or less: the
/// last one alone counts.
SettledMean settled_mean(std::span<const double> values);

} // namespace undula::fom
