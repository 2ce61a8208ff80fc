#include "fom/output/series_statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"

namespace undula::fom {
namespace {

struct Extremes {
  double low = 0, high = 0;
  double mean() const { return 0.5 * (low + high); }
  double amplitude() const { return 0.5 * (high - low); }
};

struct Samples {
  std::vector<double> time, value;

  Extremes extremes(std::size_t first, std::size_t end) const {
    const auto [low, high] = std::minmax_element(value.begin() + static_cast<std::ptrdiff_t>(first),
                                                 value.begin() + static_cast<std::ptrdiff_t>(end));
    return {*low, *high};
  }
};

/// An upward crossing between the rows `row - 1` and `row`.
struct Crossing {
  double time = 0;
  std::size_t row = 0;
};

std::vector<Crossing> upward_crossings(const Samples& samples, const Extremes& window) {
  constexpr double noise = 0.1; // of the amplitude
  const double mean = window.mean(), band = noise * window.amplitude();
  std::vector<Crossing> crossings;
  bool below = false;
  Crossing latest;
  for (std::size_t row = 0; row < samples.value.size(); ++row) {
    const double value = samples.value[row] - mean;
    if (row > 0 && samples.value[row - 1] < mean && value >= 0) {
      const double before = samples.value[row - 1] - mean;
      latest = {
          samples.time[row - 1] + (samples.time[row] - samples.time[row - 1]) * (-before) / (value - before),
          row};
    }
    if (below && value > band) {
      crossings.push_back(latest);
      below = false;
    }
    if (value < -band) below = true;
  }
  return crossings;
}

} // namespace

std::vector<ColumnStatistics> series_statistics(const TimeSeries& table, double from) {
  const auto found = std::find(table.columns.begin(), table.columns.end(), "time_s");
  if (found == table.columns.end())
    throw InputError("a table without time has no statistics", "no column \"time_s\"",
                     "a time series of a run", "statistics of a time series");
  const auto time_column = static_cast<std::size_t>(found - table.columns.begin());
  std::vector<ColumnStatistics> all;
  for (std::size_t column = 0; column < table.columns.size(); ++column) {
    if (column == time_column || table.rows() == 0) continue;
    Samples samples;
    const bool window_empty = table.value(table.rows() - 1, time_column) < from;
    for (std::size_t row = 0; row < table.rows(); ++row) {
      if (!window_empty && table.value(row, time_column) < from) continue;
      samples.time.push_back(table.value(row, time_column));
      samples.value.push_back(table.value(row, column));
    }
    ColumnStatistics one;
    one.column = table.columns[column];
    one.last = table.value(table.rows() - 1, column);
    auto extremes = samples.extremes(0, samples.value.size());
    const double size = std::max(std::abs(extremes.low), std::abs(extremes.high));
    std::array<std::size_t, 3> halves = {0, samples.value.size() / 2, samples.value.size()};
    if (extremes.amplitude() > 1e-9 * size) {
      const auto crossings = upward_crossings(samples, extremes);
      const std::size_t n = crossings.size();
      if (n > 1) {
        one.oscillations = static_cast<int>(n) - 1;
        one.frequency_Hz = one.oscillations / (crossings.back().time - crossings.front().time);
        extremes = samples.extremes(crossings[n - 2].row, crossings.back().row);
      }
      if (n > 2) halves = {crossings[n - 3].row, crossings[n - 2].row, crossings[n - 1].row};
    }
    one.mean = extremes.mean();
    one.amplitude = extremes.amplitude();
    if (halves[1] > halves[0]) {
      const auto before = samples.extremes(halves[0], halves[1]);
      const auto after = samples.extremes(halves[1], halves[2]);
      one.mean_change = after.mean() - before.mean();
      one.amplitude_change = after.amplitude() - before.amplitude();
    }
    all.push_back(std::move(one));
  }
  return all;
}

std::vector<std::string> unsettled_columns(const std::vector<ColumnStatistics>& statistics) {
  constexpr double settled = 0.05;
  std::vector<std::string> columns;
  for (const auto& one : statistics) {
    const double size = std::max(std::abs(one.mean), one.amplitude);
    if (std::max(std::abs(one.mean_change), std::abs(one.amplitude_change)) > settled * size)
      columns.push_back(one.column);
  }
  return columns;
}

void write_statistics(const std::vector<ColumnStatistics>& statistics, const std::filesystem::path& file) {
  std::string text = "column,last,mean,amplitude,frequency_Hz,oscillations,mean_change,amplitude_change\n";
  for (const auto& one : statistics)
    text += one.column + "," + exact_number(one.last) + "," + exact_number(one.mean) + "," +
            exact_number(one.amplitude) + "," + exact_number(one.frequency_Hz) + "," +
            std::to_string(one.oscillations) + "," + exact_number(one.mean_change) + "," +
            exact_number(one.amplitude_change) + "\n";
  replace_text_file(file, text);
}

} // namespace undula::fom
