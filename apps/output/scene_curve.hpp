// A head-flow curve of a full-order scene as table, JSON and picture.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/apps.hpp"
#include "apps/input/measured_curve.hpp"
#include "fom/scene/scene.hpp"
#include "rom/base/phase_timer.hpp"
#include "rom/curve/hq_curve.hpp"
#include "training/calibration/uncertainty.hpp"
#include "training/campaign/curve.hpp"

namespace undula::apps {

/// What `undula hq SCENE --json` prints, read back.
struct SceneCurve {
  double frequency_Hz = 0, stroke_mm = 0;
  int unknowns = 0;
  double seconds_per_point = 0;                  ///< wall time, preparation shared among the points
  std::vector<double> head_mmHg, flow_l_per_min; ///< same length
};

/// Reads a file printed by `undula hq SCENE --json`, without the heads where the numerics failed. Throws
/// InputError for a missing file or another content.
SceneCurve read_scene_curve(const std::filesystem::path& file);

/// What was asked of a scene and what was answered.
struct SceneReport {
  const Scene& scene;
  int unknowns = 0;
  std::span<const CurvePoint> points;
  const PhaseTimer& preparation;
  double seconds = 0;                      ///< wall time of preparation and curve
  const MeasuredCurve* measured = nullptr; ///< nullptr: no data given
  const UncertaintyBand* band = nullptr;   ///< by the tolerances of the scene; nullptr: not asked for
  std::span<const rom::HqPoint> reduced;   ///< a reduced model at the same heads; empty: none beside it
};

/// Columns head, flows, spread, speed, clearance, periods; with data also the measured fit at that head,
/// with a reduced model beside it its flow. Numbers are "failed" where the numerics failed.
std::string scene_curve_table(const SceneReport& report);

/// What each tolerance does to the flow at the lowest, middle and highest head; needs a band.
std::string sensitivity_table(const SceneReport& report);

/// JSON: `points[]` as of a reduced model (hq_json) without inside_training_box, error_l_per_min that of the
/// band (null without one), and what CurvePoint holds besides; null where the numerics failed. With a band
/// also `tolerances[]`, the change of the flow at every head by either end of every tolerance.
std::string scene_curve_json(const SceneReport& report);

/// The curve as a line with its points, other runs at this frequency and stroke, measured samples. Returns
/// false, after a warning, where gnuplot is missing.
bool plot_scene_curve(const std::filesystem::path& picture, const SceneReport& report,
                      const std::optional<SceneCurve>& other_runs);

} // namespace undula::apps
