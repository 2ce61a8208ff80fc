// A calibration as table, JSON, picture and scene file.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "apps/apps.hpp"
#include "apps/input/measured_curve.hpp"
#include "training/calibration/profile.hpp"

namespace undula::apps {

struct KeyProfile {
  std::string key;
  std::vector<ProfilePoint> points;
};

/// What was asked and what was answered.
struct CalibrationReport {
  const Scene& scene; ///< the calibrated one
  std::span<const FreeKey> keys;
  std::span<const TargetCurve> targets;
  const Calibration& calibration;
  std::span<const KeyProfile> profiles;
};

/// Tables of keys, curves and sensitivities, correlations, profiles, and what the data do not fix.
std::string calibration_table(const CalibrationReport& report);

/// The same as JSON; null for numbers that the data do not fix.
std::string calibration_json(const CalibrationReport& report);

/// The calibrated scene with a comment on its origin: data, free keys, ranges, residuals. Paths start at
/// `folder`.
std::string calibrated_scene_text(const CalibrationReport& report, const std::filesystem::path& folder);

/// Measured samples, the curves at the start (dashed) and at the optimum. Returns false, after a warning,
/// where gnuplot is missing.
bool plot_calibration(const std::filesystem::path& picture, const CalibrationReport& report,
                      std::span<const MeasuredCurve> measured);

} // namespace undula::apps
