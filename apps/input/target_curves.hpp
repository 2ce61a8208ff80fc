// Measured curves as what a scene is compared with: heads, flows and how the pump was driven.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/apps.hpp"
#include "apps/input/measured_curve.hpp"
#include "training/calibration/calibrate.hpp"

namespace undula::apps {

/// Frequency and drive of measured data by the command line, in place of what their file states.
struct DataSetting {
  std::optional<double> frequency_Hz, stroke_mm, voltage_V;
};

/// Every curve at `points` heads, spread over its measured range, with the flows of its fit. `files` are
/// their names. Throws InputError for a setting that the scene's drive has no use for, that is missing, or
/// that is given for several files; warns where it differs from the file's.
std::vector<TargetCurve> target_curves(const Scene& scene, std::span<const std::string> files,
                                       std::span<const MeasuredCurve> measured, const DataSetting& given,
                                       int points);

} // namespace undula::apps
