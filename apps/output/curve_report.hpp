// A head-flow curve as table, JSON and picture, whatever level computed it.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/apps.hpp"
#include "apps/input/measured_curve.hpp"
#include "apps/input/recorded_curve.hpp"
#include "apps/output/curve_band.hpp"
#include "fom/levels/curve_point.hpp"
#include "fom/scene/scene.hpp"
#include "rom/base/phase_timer.hpp"

namespace undula::apps {

/// What was asked and what was answered.
struct CurveReport {
  const Scene& scene;
  std::string level;      ///< Level::name
  std::string model_file; ///< of a reduced model, else empty
  int unknowns = 0;
  std::span<const CurvePoint> points;
  const PhaseTimer& preparation;
  double seconds = 0;                      ///< wall time of preparation and curve
  const MeasuredCurve* measured = nullptr; ///< nullptr: no data given
  const CurveBand* band = nullptr;         ///< by the tolerances of the scene; nullptr: not asked for
  std::string beside_level;                ///< of another level at the same heads, else empty
  std::span<const CurvePoint> beside;
  std::span<const RecordedCurve> recorded; ///< runs at this frequency and stroke, for the picture
};

/// The fit within the measured range of heads (l/min), nothing outside.
std::optional<double> measured_flow(const MeasuredCurve& curve, double head_mmHg);

/// JSON knows neither infinity nor NaN: null in their place.
nlohmann::ordered_json finite_or_null(double value);

/// Columns head, flow, and what the level knows besides: error, training box, inflow, spread, speed,
/// clearance, periods; with data the measured fit at that head, with another level beside it its flow. Flows
/// are "failed" where the numerics failed, errors "unknown".
std::string curve_table(const CurveReport& report);

/// What each tolerance does to the flow at the lowest, middle and highest head; needs a band.
std::string sensitivity_table(const CurveReport& report);

/// JSON: `level`, `unknowns`, and `points[]` with what CurvePoint holds, null for what is unknown;
/// error_l_per_min is that of the level, or of the band. With data also measured_l_per_min (null outside of
/// them). With a band also `tolerances[]`, the change of the flow at every head by either end of every
/// tolerance.
/// Several curves are an array `curves[]` of such objects.
std::string curves_json(std::span<const CurveReport> reports);

/// Every curve as a line with its band or error estimate, the level beside it as another, recorded runs and
/// measured samples as points. Returns false, after a warning, where gnuplot is missing.
bool plot_curve_reports(const std::filesystem::path& picture, std::span<const CurveReport> reports);

} // namespace undula::apps
