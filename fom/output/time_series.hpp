// Observables per time step (a growing CSV table) and per period (means, extremes).
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "rom/base/text_file.hpp"

namespace undula::fom {

/// A table with one row per time step. Column names end in their unit ("time_s", "outflow_l_per_min").
struct TimeSeries {
  std::vector<std::string> columns; ///< without the leading column "step"
  std::vector<int> steps;           ///< consecutive, ascending
  std::vector<double> values;       ///< [row][column]

  std::size_t rows() const { return steps.size(); }
  double value(std::size_t row, std::size_t column) const { return values[row * columns.size() + column]; }
};

/// Reads a table written by TimeSeriesFile, bit for bit; a last line cut short by a kill is left out. Throws
/// InputError, naming the line, for anything else that is not such a table.
TimeSeries read_time_series(const std::filesystem::path& file);

/// The rows up to the first one that is damaged, as a machine that lost its power may leave them. Throws
/// InputError if not even the header can be read.
TimeSeries read_whole_rows(const std::filesystem::path& file);

/// The same table in memory and in a CSV file ("step,<columns>"), handed over row by row. For one rank.
class TimeSeriesFile {
public:
  /// Starts an empty table in the place of an existing one.
  static TimeSeriesFile start(const std::filesystem::path& file, std::vector<std::string> columns);

  /// Goes on after a checkpoint: keeps the rows up to `last_step` and drops later ones, damaged ones
  /// included. A missing file starts anew. Throws InputError for other columns or for a table whose whole
  /// rows end before `last_step`.
  static TimeSeriesFile go_on(const std::filesystem::path& file, std::vector<std::string> columns,
                              int last_step);

  /// Appends the row of the next step. Throws InputError for a wrong number of values or a step that does not
  /// follow the last one, NumericsError when the disk is full.
  void append(int step, std::span<const double> values);

  /// Brings all rows to the disk: before a checkpoint that relies on them.
  void sync() { out_.sync(); }

  const TimeSeries& table() const { return table_; }

private:
  TimeSeriesFile(std::filesystem::path file, TimeSeries table);

  std::filesystem::path file_;
  TimeSeries table_;
  AppendedFile out_;
};

/// One row per period and column: mean, least and greatest of the period's steps.
struct CycleMeans {
  std::vector<std::string> columns;
  std::vector<int> periods;                   ///< numbered from 1
  std::vector<double> mean, minimum, maximum; ///< [period][column]
};

/// Summarises the complete periods of a table; period n holds the steps (n-1) N + 1 .. n N, N =
/// `steps_per_period`. With equal steps the mean over the steps is the trapezoidal rule for periodic signals.
/// The column "time_s" is left out.
CycleMeans summarise_cycles(const TimeSeries& table, int steps_per_period);

/// Means of one column, by period. `cycles` holds the column.
std::vector<double> period_means(const CycleMeans& cycles, const std::string& column);

/// Writes "period,mean_<column>,min_<column>,max_<column>,..." in one step, so that the file is whole at any
/// time.
void write_cycle_means(const CycleMeans& cycles, const std::filesystem::path& file);

} // namespace undula::fom
