#include "fom/output/time_series.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>
#include <string_view>

#include "rom/base/error.hpp"

namespace undula::fom {
namespace {

std::string joined(const std::vector<std::string>& columns) {
  std::string text = "step";
  for (const auto& column : columns) text += "," + column;
  return text;
}

void append_row(std::string& text, int step, std::span<const double> values) {
  text += std::to_string(step);
  for (const double value : values) text += "," + exact_number(value);
  text += '\n';
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const auto comma = line.find(',');
    fields.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

template <class Number>
bool parse(std::string_view text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

void check_columns(const std::vector<std::string>& columns, const std::filesystem::path& file) {
  const std::set<std::string> distinct(columns.begin(), columns.end());
  const bool plain = std::all_of(columns.begin(), columns.end(), [](const std::string& name) {
    return !name.empty() && name.find_first_of(",\n\"") == std::string::npos;
  });
  if (columns.empty() || !plain || distinct.size() != columns.size())
    throw InputError("bad column names of a time series", joined(columns),
                     "different, non-empty names without commas and quotes", file.string());
}

/// `table` gets the rows before the first damaged one; returns the error that tells of that one, if any.
std::optional<InputError> read_rows(const std::filesystem::path& file, TimeSeries& table) {
  const std::string text = read_text_file(file);
  std::string_view rest = text;
  for (int line_number = 1;; ++line_number) {
    const auto end = rest.find('\n');
    if (end == std::string_view::npos)
      return std::nullopt; // what follows was being written when the run was killed
    const auto line = rest.substr(0, end);
    rest.remove_prefix(end + 1);
    const auto fields = fields_of(line);
    const auto error = [&](const std::string& allowed) {
      return InputError("not a row of a time series", std::string(line.substr(0, 80)), allowed,
                        file.string() + ", line " + std::to_string(line_number));
    };
    if (line_number == 1) {
      if (fields[0] != "step" || fields.size() < 2) return error("a header that starts with \"step,\"");
      table.columns.assign(fields.begin() + 1, fields.end());
      continue;
    }
    if (fields.size() != table.columns.size() + 1) return error("as many values as the header has columns");
    int step = 0;
    if (!parse(fields[0], step) || step < 0 || (!table.steps.empty() && step != table.steps.back() + 1))
      return error("the number of the step after the last one");
    std::vector<double> values(table.columns.size());
    for (std::size_t k = 0; k < values.size(); ++k)
      if (!parse(fields[k + 1], values[k])) return error("numbers");
    table.steps.push_back(step);
    table.values.insert(table.values.end(), values.begin(), values.end());
  }
}

void require_header(const TimeSeries& table, const std::filesystem::path& file) {
  if (table.columns.empty())
    throw InputError("not a time series", "no header", "a first line \"step,...\"", file.string());
}

std::string whole_text(const TimeSeries& table) {
  std::string text = joined(table.columns) + "\n";
  const auto width = table.columns.size();
  for (std::size_t row = 0; row < table.rows(); ++row)
    append_row(text, table.steps[row], {table.values.data() + row * width, width});
  return text;
}

/// Opens the file for further rows once it holds those of the table.
AppendedFile write_and_open(const std::filesystem::path& file, const TimeSeries& table) {
  replace_text_file(file, whole_text(table));
  return AppendedFile(file);
}

} // namespace

TimeSeries read_time_series(const std::filesystem::path& file) {
  TimeSeries table;
  if (const auto error = read_rows(file, table)) throw *error;
  require_header(table, file);
  return table;
}

TimeSeries read_whole_rows(const std::filesystem::path& file) {
  TimeSeries table;
  (void)read_rows(file, table);
  require_header(table, file);
  return table;
}

TimeSeriesFile::TimeSeriesFile(std::filesystem::path file, TimeSeries table)
    : file_(std::move(file)), table_(std::move(table)), out_(write_and_open(file_, table_)) {}

TimeSeriesFile TimeSeriesFile::start(const std::filesystem::path& file, std::vector<std::string> columns) {
  check_columns(columns, file);
  return {file, {std::move(columns), {}, {}}};
}

TimeSeriesFile TimeSeriesFile::go_on(const std::filesystem::path& file, std::vector<std::string> columns,
                                     int last_step) {
  if (!std::filesystem::exists(file)) return start(file, std::move(columns));
  auto table = read_whole_rows(file);
  if (table.columns != columns)
    throw InputError("the time series has other columns than this run", joined(table.columns),
                     joined(columns), file.string());
  if (last_step > 0 && (table.steps.empty() || table.steps.back() < last_step))
    throw InputError("the time series ends before the checkpoint",
                     table.steps.empty() ? "no rows" : "last step " + std::to_string(table.steps.back()),
                     "rows up to step " + std::to_string(last_step) + ", or no file at all", file.string());
  const auto end = std::upper_bound(table.steps.begin(), table.steps.end(), last_step);
  table.steps.erase(end, table.steps.end());
  table.values.resize(table.steps.size() * table.columns.size());
  return {file, std::move(table)};
}

void TimeSeriesFile::append(int step, std::span<const double> values) {
  if (values.size() != table_.columns.size() || (!table_.steps.empty() && step != table_.steps.back() + 1))
    throw InputError("row does not fit the time series",
                     "step " + std::to_string(step) + " with " + std::to_string(values.size()) + " values",
                     std::to_string(table_.columns.size()) + " values of the step after the last one",
                     file_.string());
  std::string row;
  append_row(row, step, values);
  out_.append(row);
  table_.steps.push_back(step);
  table_.values.insert(table_.values.end(), values.begin(), values.end());
}

CycleMeans summarise_cycles(const TimeSeries& table, int steps_per_period) {
  if (steps_per_period < 1)
    throw InputError("cannot average over a period", std::to_string(steps_per_period) + " steps per period",
                     "at least 1", "time.steps_per_period");
  CycleMeans cycles;
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    if (table.columns[k] == "time_s") continue;
    kept.push_back(k);
    cycles.columns.push_back(table.columns[k]);
  }
  const auto length = static_cast<std::size_t>(steps_per_period);
  // A table that goes on from a checkpoint may begin inside a period; the first complete one begins at a
  // step n N + 1.
  std::size_t begin = 0;
  while (begin < table.rows() && (table.steps[begin] < 1 || (table.steps[begin] - 1) % steps_per_period != 0))
    ++begin;
  for (; begin + length <= table.rows(); begin += length) {
    cycles.periods.push_back((table.steps[begin] - 1) / steps_per_period + 1);
    for (const auto column : kept) {
      double sum = 0, low = table.value(begin, column), high = low;
      for (std::size_t row = begin; row < begin + length; ++row) {
        const double value = table.value(row, column);
        sum += value;
        low = std::min(low, value);
        high = std::max(high, value);
      }
      cycles.mean.push_back(sum / steps_per_period);
      cycles.minimum.push_back(low);
      cycles.maximum.push_back(high);
    }
  }
  return cycles;
}

std::vector<double> period_means(const CycleMeans& cycles, const std::string& column) {
  const auto width = cycles.columns.size();
  const auto place = static_cast<std::size_t>(
      std::find(cycles.columns.begin(), cycles.columns.end(), column) - cycles.columns.begin());
  std::vector<double> means;
  for (std::size_t at = place; at < cycles.mean.size(); at += width) means.push_back(cycles.mean[at]);
  return means;
}

void write_cycle_means(const CycleMeans& cycles, const std::filesystem::path& file) {
  std::string text = "period";
  for (const auto& column : cycles.columns) text += ",mean_" + column + ",min_" + column + ",max_" + column;
  text += '\n';
  const auto width = cycles.columns.size();
  for (std::size_t row = 0; row < cycles.periods.size(); ++row) {
    text += std::to_string(cycles.periods[row]);
    for (std::size_t i = row * width; i < (row + 1) * width; ++i)
      for (const double value : {cycles.mean[i], cycles.minimum[i], cycles.maximum[i]})
        text += "," + exact_number(value);
    text += '\n';
  }
  replace_text_file(file, text);
}

} // namespace undula::fom
