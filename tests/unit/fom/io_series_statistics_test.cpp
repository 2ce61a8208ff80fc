#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fom/output/series_statistics.hpp"
#include "io_folder.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"

namespace undula::fom {
namespace {

using std::numbers::pi;

/// Columns of time: one decays onto an oscillation 3 +- 2 at 5.25 Hz, one is constant, one rises.
TimeSeries oscillating(double wiggle) {
  TimeSeries table{{"time_s", "swing_mm", "still_mm", "rise_mm"}, {}, {}};
  for (int step = 1; step <= 2000; ++step) {
    const double t = 1e-3 * step;
    table.steps.push_back(step);
    table.values.insert(
        table.values.end(),
        {t, 3 + 20 * std::exp(-20 * t) + 2 * std::sin(2 * pi * 5.25 * t) + wiggle * (step % 2), 7.0, t});
  }
  return table;
}

TEST(SeriesStatistics, MeanAmplitudeAndFrequencyOfTheLastOscillation) {
  const auto all = series_statistics(oscillating(0), 1.0);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].column, "swing_mm");
  EXPECT_NEAR(all[0].mean, 3, 1e-3);
  EXPECT_NEAR(all[0].amplitude, 2, 1e-3);
  EXPECT_NEAR(all[0].frequency_Hz, 5.25, 1e-4);
  EXPECT_EQ(all[0].oscillations, 4);
  EXPECT_EQ(all[1].mean, 7);
  EXPECT_EQ(all[1].amplitude, 0);
  EXPECT_EQ(all[1].oscillations, 0);
  EXPECT_NEAR(all[2].mean, 1.5, 1e-12);
  EXPECT_NEAR(all[2].last, 2, 1e-12);
  EXPECT_EQ(all[2].frequency_Hz, 0);
}

TEST(SeriesStatistics, WigglesAtTheMeanAreNoOscillations) {
  EXPECT_NEAR(series_statistics(oscillating(0.1), 1.0)[0].frequency_Hz, 5.25, 0.01);
}

TEST(SeriesStatistics, AWindowBehindTheEndIsTheWholeTable) {
  EXPECT_NEAR(series_statistics(oscillating(0), 3.0)[2].mean, 0.5 * (0.001 + 2), 1e-12);
}

/// A swing of 10 Hz that grows by `rate` per second, about a mean that rises by `slope` per second.
TimeSeries growing(double rate, double slope) {
  TimeSeries table{{"time_s", "swing_mm"}, {}, {}};
  for (int step = 1; step <= 2000; ++step) {
    const double t = 1e-3 * step;
    table.steps.push_back(step);
    table.values.insert(table.values.end(),
                        {t, 1 + slope * t + std::exp(rate * t) * std::sin(2 * pi * 10 * t)});
  }
  return table;
}

TEST(SeriesStatistics, SayHowTheLastOscillationDiffersFromTheOneBefore) {
  EXPECT_TRUE(unsettled_columns(series_statistics(growing(0, 0), 1.0)).empty());
  const auto grows = series_statistics(growing(1, 0), 1.0)[0];
  EXPECT_NEAR(grows.amplitude_change / grows.amplitude, 0.1, 0.02); // exp(0.1) per period
  EXPECT_EQ(unsettled_columns({grows}), std::vector<std::string>{"swing_mm"});
  const auto rises = series_statistics(growing(0, 2), 1.0)[0];
  EXPECT_NEAR(rises.mean_change, 0.2, 0.02);
  EXPECT_LT(std::abs(rises.amplitude_change), 0.02);
}

TEST(SeriesStatistics, ComparesTheHalvesOfAWindowWithoutOscillations) {
  const auto all = series_statistics(oscillating(0), 1.0);
  EXPECT_NEAR(all[2].mean_change, 0.5, 2e-3); // a ramp from 1 to 2
  EXPECT_EQ(all[1].mean_change, 0);
  EXPECT_EQ(unsettled_columns(all), std::vector<std::string>{"rise_mm"});
}

TEST(SeriesStatistics, ATableNeedsItsTime) {
  EXPECT_THROW(series_statistics({{"swing_mm"}, {1}, {2.0}}, 0), InputError);
}

class SeriesStatisticsFile : public FolderTest {};

TEST_F(SeriesStatisticsFile, HasOneLinePerColumn) {
  write_statistics({{"swing_mm", 1.5, 3, 2, 5.25, 4, 0.5, -0.25}}, folder / "statistics.csv");
  EXPECT_EQ(read_text_file(folder / "statistics.csv"),
            "column,last,mean,amplitude,frequency_Hz,oscillations,mean_change,amplitude_change\n"
            "swing_mm,1.5,3,2,5.25,4,0.5,-0.25\n");
}

} // namespace
} // namespace undula::fom
