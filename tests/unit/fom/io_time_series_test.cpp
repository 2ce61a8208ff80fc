#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "fom/output/time_series.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "tests/unit/fom/io_folder.hpp"

namespace undula::fom {
namespace {

const std::vector<std::string> columns{"time_s", "outflow_l_per_min", "power_W"};

class TimeSeriesTest : public FolderTest {
protected:
  std::filesystem::path file() const { return folder / "time_series.csv"; }

  /// Values without a short decimal form.
  static std::vector<double> row(int step) { return {step / 3.0, std::exp(-step), 1e-300 / step}; }

  static void append(TimeSeriesFile& series, int first, int last) {
    for (int step = first; step <= last; ++step) series.append(step, row(step));
  }
};

TEST_F(TimeSeriesTest, ReadsBackBitForBitWhileBeingWritten) {
  auto series = TimeSeriesFile::start(file(), columns);
  append(series, 1, 7);
  const auto table = read_time_series(file()); // not closed: every row is flushed
  EXPECT_EQ(table.columns, columns);
  ASSERT_EQ(table.rows(), 7u);
  for (int step = 1; step <= 7; ++step) {
    EXPECT_EQ(table.steps[step - 1], step);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(table.value(step - 1, k), row(step)[k]);
  }
}

TEST_F(TimeSeriesTest, RestartEqualsAnUninterruptedRun) {
  {
    auto series = TimeSeriesFile::start(file(), columns);
    append(series, 1, 10);
  }
  const auto uninterrupted = read_text_file(file());
  {
    auto series = TimeSeriesFile::start(file(), columns);
    append(series, 1, 8); // killed after step 8, checkpoint at 5
  }
  {
    auto series = TimeSeriesFile::go_on(file(), columns, 5);
    EXPECT_EQ(series.table().rows(), 5u);
    EXPECT_EQ(read_time_series(file()).rows(), 5u);
    append(series, 6, 10);
  }
  EXPECT_EQ(read_text_file(file()), uninterrupted);
}

TEST_F(TimeSeriesTest, DropsALineCutShortByAKill) {
  {
    auto series = TimeSeriesFile::start(file(), columns);
    append(series, 1, 4);
  }
  const auto whole = read_text_file(file());
  const auto last_line = whole.rfind('\n', whole.size() - 2) + 1;
  for (std::size_t size = last_line; size < whole.size(); ++size) {
    replace_text_file(file(), whole.substr(0, size));
    EXPECT_EQ(read_time_series(file()).rows(), 3u);
  }
}

TEST_F(TimeSeriesTest, RefusesWhatDoesNotFit) {
  {
    auto series = TimeSeriesFile::start(file(), columns);
    append(series, 1, 4);
    EXPECT_THROW(series.append(6, row(6)), InputError);
    EXPECT_THROW(series.append(5, std::vector<double>{1, 2}), InputError);
  }
  EXPECT_THROW(TimeSeriesFile::go_on(file(), columns, 5), InputError);
  EXPECT_THROW(TimeSeriesFile::go_on(file(), {"time_s", "inflow_l_per_min", "power_W"}, 3), InputError);
  EXPECT_THROW(TimeSeriesFile::start(file(), {"a", "a"}), InputError);
  EXPECT_THROW(TimeSeriesFile::start(file(), {"a,b"}), InputError);
  EXPECT_EQ(read_time_series(file()).rows(), 4u); // none of these touched the file
  for (const std::string bad :
       {"", "time_s,flow\n", "step,a\n1,2,3\n", "step,a\n1,x\n", "step,a\n1,2\n3,4\n"}) {
    replace_text_file(file(), bad);
    EXPECT_THROW(read_time_series(file()), InputError) << bad;
  }
  EXPECT_THROW(read_time_series(folder / "missing.csv"), InputError);
}

TEST_F(TimeSeriesTest, SummarisesCompletePeriods) {
  auto series = TimeSeriesFile::start(file(), {"time_s", "flow_l_per_min"});
  const int steps = 16;
  for (int step = 1; step <= 2 * steps + 5; ++step) {
    const double phase = 2 * std::numbers::pi * step / steps;
    const double level = step <= steps ? 3 : 4;
    series.append(step, std::vector{0.1 * step, level + 2 * std::sin(phase)});
  }
  const auto cycles = summarise_cycles(series.table(), steps);
  EXPECT_EQ(cycles.columns, std::vector<std::string>{"flow_l_per_min"});
  ASSERT_EQ(cycles.periods, (std::vector{1, 2}));
  for (int k = 0; k < 2; ++k) {
    EXPECT_NEAR(cycles.mean[k], 3 + k, 1e-14);
    EXPECT_NEAR(cycles.minimum[k], 1 + k, 1e-14);
    EXPECT_NEAR(cycles.maximum[k], 5 + k, 1e-14);
  }
  write_cycle_means(cycles, folder / "cycle_means.csv");
  const auto text = read_text_file(folder / "cycle_means.csv");
  EXPECT_TRUE(text.starts_with("period,mean_flow_l_per_min,min_flow_l_per_min,max_flow_l_per_min\n1,"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
}

TEST_F(TimeSeriesTest, SkipsThePeriodInWhichATableBegins) {
  auto series = TimeSeriesFile::start(file(), {"flow_l_per_min"});
  for (int step = 7; step <= 15; ++step) series.append(step, std::vector{double(step)});
  const auto cycles = summarise_cycles(series.table(), 5); // periods 1..5, 6..10, 11..15
  ASSERT_EQ(cycles.periods, std::vector{3});
  EXPECT_EQ(cycles.mean[0], 13);
  EXPECT_EQ(cycles.minimum[0], 11);
  EXPECT_EQ(cycles.maximum[0], 15);
}

} // namespace
} // namespace undula::fom
