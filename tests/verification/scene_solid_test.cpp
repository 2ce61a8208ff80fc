// Solids without a fluid that a scene file states: the flag of Turek & Hron (2006) under its own weight.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/verification/support/run_scene.hpp"

namespace undula::verification {
namespace {

void expect_the_published_rest(const char* name, double ux, double uy) {
  const auto run = run_scene(name, {});
  const double x = run.last("A_displacement_x_mm"), y = run.last("A_displacement_y_mm");
  std::printf("scene %s, %d unknowns: ux %.4f mm (%+.3f %%), uy %.4f mm (%+.3f %%)\n", name, run.unknowns, x,
              100 * (x / ux - 1), y, 100 * (y / uy - 1));
  EXPECT_NEAR(x, ux, 0.002 * std::abs(ux));
  EXPECT_NEAR(y, uy, 0.002 * std::abs(uy));
}

TEST(SceneSolid, FlagHangsAsInCsm1) { expect_the_published_rest("turek_hron_csm1", -7.187, -66.10); }
TEST(SceneSolid, FlagHangsAsInCsm2) { expect_the_published_rest("turek_hron_csm2", -0.4690, -16.97); }

/// Extrema of a signal by parabolas through three samples.
struct Extremum {
  double time, value;
};
struct Extrema {
  std::vector<Extremum> minima, maxima;
};
Extrema extrema(const std::vector<double>& signal, double dt) {
  Extrema found;
  for (std::size_t i = 1; i + 1 < signal.size(); ++i) {
    const double before = signal[i] - signal[i - 1], after = signal[i + 1] - signal[i];
    if (before * after > 0 || before == after) continue;
    const double s = 0.5 * (before + after) / (before - after), second = after - before;
    const Extremum at{(static_cast<double>(i) + s) * dt,
                      signal[i] + 0.5 * (before + after) * s + 0.5 * second * s * s};
    (before < 0 ? found.minima : found.maxima).push_back(at);
  }
  return found;
}

double average(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// CSM3: the flag falls from rest and swings. Its second mode of vibration, which the fall sets going too and
/// nothing damps, makes the extrema of the swings differ by 1 %, so they are averaged over all whole swings;
/// the published ones are those of one swing.
void expect_the_published_swing(const std::vector<std::string>& settings) {
  const auto run = run_scene("turek_hron_csm3", settings);
  const double dt = run.scene.time.step;
  auto ux = run.column("A_displacement_x_mm"), uy = run.column("A_displacement_y_mm");
  for (auto* signal : {&ux, &uy}) signal->insert(signal->begin(), 0.0);
  // A swing goes from one fall through the middle to the next. Near its ends the second mode makes more than
  // one extremum.
  const double middle =
      0.5 * (*std::min_element(uy.begin(), uy.end()) + *std::max_element(uy.begin(), uy.end()));
  std::vector<std::size_t> falls;
  std::vector<double> times;
  for (std::size_t i = 1; i < uy.size(); ++i)
    if (uy[i - 1] > middle && uy[i] <= middle) {
      falls.push_back(i);
      times.push_back(dt * (static_cast<double>(i) - (middle - uy[i]) / (uy[i - 1] - uy[i])));
    }
  std::vector<double> x_low, x_high, y_low, y_high;
  for (std::size_t n = 1; n < falls.size(); ++n) {
    const auto swing = [&](const std::vector<double>& signal) {
      return extrema({signal.begin() + static_cast<std::ptrdiff_t>(falls[n - 1]),
                      signal.begin() + static_cast<std::ptrdiff_t>(falls[n])},
                     dt);
    };
    const auto by_value = [](const Extremum& one, const Extremum& other) { return one.value < other.value; };
    const auto x = swing(ux), y = swing(uy);
    for (const auto* points : {&x.minima, &x.maxima, &y.minima, &y.maxima}) ASSERT_FALSE(points->empty());
    x_low.push_back(std::min_element(x.minima.begin(), x.minima.end(), by_value)->value);
    x_high.push_back(std::max_element(x.maxima.begin(), x.maxima.end(), by_value)->value);
    y_low.push_back(std::min_element(y.minima.begin(), y.minima.end(), by_value)->value);
    y_high.push_back(std::max_element(y.maxima.begin(), y.maxima.end(), by_value)->value);
    std::printf("  swing to %.4f s: ux %.3f .. %.3f mm, uy %.3f .. %.3f mm\n", times[n], x_low.back(),
                x_high.back(), y_low.back(), y_high.back());
  }
  ASSERT_GE(y_high.size(), 4u);
  const double mean_x = 0.5 * (average(x_high) + average(x_low)),
               amplitude_x = 0.5 * (average(x_high) - average(x_low));
  const double mean_y = 0.5 * (average(y_high) + average(y_low)),
               amplitude_y = 0.5 * (average(y_high) - average(y_low));
  const double frequency = static_cast<double>(y_high.size()) / (times.back() - times.front());
  std::printf(
      "scene turek_hron_csm3, %d unknowns, dt %.4f s: ux %.3f +- %.3f mm (%+.2f, %+.2f %%), uy %.3f +- %.3f "
      "mm "
      "(%+.2f, %+.2f %%), %.4f Hz (%+.2f %%)\n",
      run.unknowns, dt, mean_x, amplitude_x, 100 * (mean_x / -14.305 - 1), 100 * (amplitude_x / 14.305 - 1),
      mean_y, amplitude_y, 100 * (mean_y / -63.607 - 1), 100 * (amplitude_y / 65.160 - 1), frequency,
      100 * (frequency / 1.0995 - 1));
  EXPECT_NEAR(mean_x, -14.305, 0.01 * 14.305);
  EXPECT_NEAR(amplitude_x, 14.305, 0.01 * 14.305);
  EXPECT_NEAR(mean_y, -63.607, 0.01 * 63.607);
  EXPECT_NEAR(amplitude_y, 65.160, 0.01 * 65.160);
  EXPECT_NEAR(frequency, 1.0995, 0.01 * 1.0995);
}

TEST(SceneSolid, FlagSwingsAsInCsm3) {
  expect_the_published_swing({"time.step_s=0.01", "body.flag.size_mm=7", "time.end_s=4.8"});
}
TEST(SceneSolid, DISABLED_FlagSwingsAsInCsm3AsShipped) { expect_the_published_swing({}); }

} // namespace
} // namespace undula::verification
