// Mean, amplitude and frequency of the columns of a time series, as oscillations are reported: mean = (max +
// min) / 2 and amplitude = (max - min) / 2 over the last full oscillation (Turek & Hron 2006).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fom/output/time_series.hpp"

namespace undula::fom {

/// In the unit of the column.
struct ColumnStatistics {
  std::string column;
  double last = 0;      ///< value of the last row
  double mean = 0;      ///< (max + min) / 2 over the last full oscillation, or the whole window
  double amplitude = 0; ///< (max - min) / 2 over the same
  double frequency_Hz =
      0;                ///< from the upward crossings of the mean in the window; 0: less than one oscillation
  int oscillations = 0; ///< full ones in the window
  /// Of the last full oscillation against the one before; of the second half of the window against the first
  /// where it has less than two.
  double mean_change = 0, amplitude_change = 0;
};

/// Of every column but "time_s", over the rows from time `from` (s) on, or all if the table ends before it.
/// Oscillations run from one upward crossing of the window's mean to the next; wiggles of less than a tenth
/// of the amplitude about the mean do not count as crossings, and a column that changes by less than 1e-9 of
/// its size does not oscillate. Throws InputError for a table without "time_s".
std::vector<ColumnStatistics> series_statistics(const TimeSeries& table, double from);

/// Columns whose mean or amplitude still changes by more than 5 % of the larger of |mean| and amplitude:
/// their statistics belong to the window, not to the problem.
std::vector<std::string> unsettled_columns(const std::vector<ColumnStatistics>& statistics);

/// "column,last,mean,amplitude,frequency_Hz,oscillations,mean_change,amplitude_change", written in one step.
void write_statistics(const std::vector<ColumnStatistics>& statistics, const std::filesystem::path& file);

} // namespace undula::fom
