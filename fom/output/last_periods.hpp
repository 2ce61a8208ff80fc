// What the last periods of a run say of one column of its cycle means.
#pragma once

#include <string>

#include "fom/output/time_series.hpp"

namespace undula::fom {

/// In the unit of the column.
struct LastPeriods {
  double mean = 0;   ///< of the last period
  double spread = 0; ///< largest minus smallest mean of the last three periods, or of all if there are fewer
};

/// `cycles` holds at least one period and the column.
LastPeriods last_periods(const CycleMeans& cycles, const std::string& column);

} // namespace undula::fom
