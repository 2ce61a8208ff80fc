// Curves that were computed before.
#pragma once

#include <filesystem>
#include <vector>

#include "rom/fixed_domain/model.hpp"

namespace undula::apps {

/// What `undula hq FILE --json` prints, read back.
struct RecordedCurve {
  double frequency_Hz = 0, stroke_mm = 0;
  int unknowns = 0;
  double seconds_per_point = 0;                  ///< wall time, preparation shared among the points
  std::vector<double> head_mmHg, flow_l_per_min; ///< same length
};

/// Reads a file printed by `undula hq FILE --json`, without the heads where the numerics failed. Throws
/// InputError for a missing file or another content.
RecordedCurve read_recorded_curve(const std::filesystem::path& file);

/// The full-order runs that a reduced model keeps of a frequency and stroke.
RecordedCurve kept_runs(const rom::Model& model, double frequency_Hz, double stroke_mm);

/// Whether two frequencies or strokes are the same but for rounding.
bool same_setting(double a, double b);

} // namespace undula::apps
