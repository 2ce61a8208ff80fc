#include "apps/scene_curve.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/text_table.hpp"
#include "base/error.hpp"
#include "base/units.hpp"
#include "fom/io/text_file.hpp"
#include "training/run_summary.hpp"

namespace undula {

ScenePoint scene_point(const RunRecord& record) {
  ScenePoint point;
  point.head_mmHg = units::pressure_to_mmHg(record.point.head);
  point.periodic = record.state == RunState::periodic;
  point.reason = record.reason;
  point.seconds = record.seconds;
  const CycleMeans& cycles = record.cycles;
  point.periods = static_cast<int>(cycles.periods.size());
  if (cycles.periods.empty()) {
    return point;
  }
  const auto place = [&](const char* column, int period) {
    const auto found = std::find(cycles.columns.begin(), cycles.columns.end(), column);
    return static_cast<std::size_t>(period) * cycles.columns.size() +
           static_cast<std::size_t>(found - cycles.columns.begin());
  };
  const int last = point.periods - 1;
  const LastPeriods outflow = last_periods(cycles, "outflow_l_per_min");
  point.flow_l_per_min = outflow.mean;
  point.spread_l_per_min = outflow.spread;
  point.inflow_l_per_min = cycles.mean[place("inflow_l_per_min", last)];
  point.power_mW = cycles.mean[place("hydraulic_power_mW", last)];
  point.speed_max_cm_per_s = cycles.maximum[place("speed_max_cm_per_s", last)];
  point.clearance_min_mm = cycles.minimum[place("clearance_min_mm", last)];
  return point;
}

std::string scene_curve_table(std::span<const ScenePoint> points) {
  std::vector<std::vector<std::string>> rows;
  for (const ScenePoint& point : points) {
    rows.push_back({decimals(point.head_mmHg, 2), decimals(point.flow_l_per_min, 4),
                    decimals(point.inflow_l_per_min, 4), decimals(point.spread_l_per_min, 4),
                    decimals(point.speed_max_cm_per_s, 1), decimals(point.clearance_min_mm, 3),
                    std::to_string(point.periods), point.periodic ? "yes" : "no",
                    decimals(point.seconds.at("total"), 1)});
  }
  return text_table({"head (mmHg)", "outflow (l/min)", "inflow (l/min)", "spread (l/min)", "max speed (cm/s)",
                     "min clearance (mm)", "periods", "periodic", "seconds"},
                    rows);
}

std::string scene_curve_json(const Scene& scene, int unknowns, std::span<const ScenePoint> points,
                             const PhaseTimer& preparation) {
  nlohmann::ordered_json result = {{"scene", scene.name},
                                   {"unknowns", unknowns},
                                   {"frequency_Hz", scene.operating_point.frequency},
                                   {"stroke_mm", units::length_to_mm(scene.operating_point.stroke)},
                                   {"preparation_seconds", nlohmann::ordered_json::object()},
                                   {"points", nlohmann::ordered_json::array()}};
  for (const auto& [phase, record] : preparation.records()) {
    result["preparation_seconds"][phase] = record.seconds;
  }
  for (const ScenePoint& point : points) {
    result["points"].push_back({{"head_mmHg", point.head_mmHg},
                                {"flow_l_per_min", point.flow_l_per_min},
                                {"inflow_l_per_min", point.inflow_l_per_min},
                                {"spread_l_per_min", point.spread_l_per_min},
                                {"hydraulic_power_mW", point.power_mW},
                                {"speed_max_cm_per_s", point.speed_max_cm_per_s},
                                {"clearance_min_mm", point.clearance_min_mm},
                                {"periods", point.periods},
                                {"periodic", point.periodic},
                                {"reason", point.reason},
                                {"seconds", point.seconds}});
  }
  return result.dump(2) + "\n";
}

SceneCurve read_scene_curve(const std::filesystem::path& file) {
  try {
    const auto json = nlohmann::json::parse(read_text_file(file));
    SceneCurve curve;
    curve.frequency_Hz = json.at("frequency_Hz").get<double>();
    curve.stroke_mm = json.at("stroke_mm").get<double>();
    for (const auto& point : json.at("points")) {
      curve.head_mmHg.push_back(point.at("head_mmHg").get<double>());
      curve.flow_l_per_min.push_back(point.at("flow_l_per_min").get<double>());
    }
    return curve;
  } catch (const nlohmann::json::exception& error) {
    throw InputError("a file of full-order runs cannot be read", error.what(),
                     "what `undula hq SCENE --json` prints", file.string());
  }
}

} // namespace undula
