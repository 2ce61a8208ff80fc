// A head-flow curve as table, JSON and picture.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>

#include "apps/input/measured_curve.hpp"
#include "rom/curve/hq_curve.hpp"
#include "rom/fixed_domain/model.hpp"

namespace undula::apps {

/// The fit within the measured range of heads (l/min), nothing outside.
std::optional<double> measured_flow(const MeasuredCurve& curve, double head_mmHg);

/// JSON knows neither infinity nor NaN: null in their place.
nlohmann::ordered_json finite_or_null(double value);

/// Whether two frequencies or strokes are the same but for rounding.
bool same_setting(double a, double b);

/// What was asked and what was answered.
struct HqReport {
  std::string model_file;
  double frequency_Hz = 0;
  double stroke_mm = 0;
  std::span<const rom::HqPoint> points;
  const MeasuredCurve* measured = nullptr; ///< nullptr: no data given
  double milliseconds = 0;                 ///< wall time of the curve, error estimates included
};

/// Columns head, flow, error estimate, inside the training box; with data also the measured fit at that head.
std::string hq_table(const HqReport& report);

/// JSON: `points[]` with head_mmHg, flow_l_per_min, error_l_per_min (null where unknown),
/// inside_training_box, converged, and measured_l_per_min (null outside the data) where data were given.
std::string hq_json(const HqReport& report);

/// Line with error band, the model's full-order runs at this frequency and stroke, measured samples.
/// Returns false, after a warning, where gnuplot is missing.
bool plot_hq_report(const std::filesystem::path& picture, const HqReport& report, const rom::Model& model);

} // namespace undula::apps
