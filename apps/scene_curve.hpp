// A head-flow curve of full-order runs as table and JSON.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "base/phase_timer.hpp"
#include "fom/scene/scene.hpp"
#include "training/campaign_store.hpp"

namespace undula {

/// One full-order run in its last period, surface units.
struct ScenePoint {
  double head_mmHg = 0;
  double flow_l_per_min = 0, inflow_l_per_min = 0;
  double spread_l_per_min = 0; ///< of the means of the last three periods
  double power_mW = 0;         ///< hydraulic
  double speed_max_cm_per_s = 0, clearance_min_mm = 0;
  int periods = 0;
  bool periodic = false;
  std::string reason; ///< why it is not
  std::map<std::string, double> seconds;
};

ScenePoint scene_point(const RunRecord& record);
std::string scene_curve_table(std::span<const ScenePoint> points);
/// What scene_curve_json writes, read back.
struct SceneCurve {
  double frequency_Hz = 0, stroke_mm = 0;
  std::vector<double> head_mmHg, flow_l_per_min; ///< same length
};

/// Reads a file printed by `undula hq SCENE --json`. Throws InputError for a missing file or another content.
SceneCurve read_scene_curve(const std::filesystem::path& file);

std::string scene_curve_json(const Scene& scene, int unknowns, std::span<const ScenePoint> points,
                             const PhaseTimer& preparation);

} // namespace undula
