// Speed against error of several computations of one measured curve, as table, JSON and picture.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace undula::apps {

/// One computation at the heads of the comparison. Flows in l/min; NaN where there is none.
struct LevelResult {
  std::string level;            ///< Level::name, or "full order, recorded"
  std::string source;           ///< file, and what was varied in it
  int unknowns = 0;             ///< of one time step
  std::vector<double> flow;     ///< at the heads
  double seconds_per_point = 0; ///< wall time, preparation shared among the points
  /// Computation whose curve this one should repeat (a finer setting, the full-order runs of a reduced
  /// model): its index among the results; -1: none.
  int reference = -1;
};

struct LevelReport {
  std::string data_file;
  double frequency_Hz = 0, stroke_mm = 0;
  std::vector<double> head_mmHg;
  std::vector<double> measured; ///< fit of the data at the heads, l/min
  double scatter_l_per_min = 0; ///< of a sample about the fit
  std::vector<LevelResult> results;
};

/// Root mean square and largest magnitude of the difference of two curves where both have points; NaN if
/// nowhere.
struct CurveDifference {
  double rms = 0, largest = 0;
  int points = 0;
};
CurveDifference curve_difference(std::span<const double> a, std::span<const double> b);

std::string level_report_table(const LevelReport& report);
std::string level_report_json(const LevelReport& report);

/// Seconds per point against the root mean square error to the data, both logarithmic, with the data's own
/// scatter. Returns false, after a warning, where gnuplot is missing.
bool plot_level_report(const std::filesystem::path& picture, const LevelReport& report);

} // namespace undula::apps
