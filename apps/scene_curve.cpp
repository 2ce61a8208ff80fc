#include "apps/scene_curve.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/hq_report.hpp"
#include "apps/plots.hpp"
#include "apps/text_table.hpp"
#include "base/error.hpp"
#include "base/units.hpp"
#include "fom/io/text_file.hpp"

namespace undula {
namespace {

double stroke_mm(const Scene& scene) { return units::length_to_mm(scene.operating_point.stroke); }

std::string number_or_failed(double value, int count) {
  return std::isfinite(value) ? decimals(value, count) : "failed";
}

} // namespace

std::string scene_curve_table(const SceneReport& report) {
  std::vector<std::string> header = {"head (mmHg)",    "outflow (l/min)",  "inflow (l/min)",
                                     "spread (l/min)", "max speed (cm/s)", "min clearance (mm)",
                                     "periods",        "periodic",         "seconds"};
  if (report.measured != nullptr) {
    header.emplace_back("measured, fit (l/min)");
  }
  std::vector<std::vector<std::string>> rows;
  for (const CurvePoint& point : report.points) {
    rows.push_back({decimals(point.head_mmHg, 2), number_or_failed(point.flow_l_per_min, 4),
                    number_or_failed(point.inflow_l_per_min, 4), number_or_failed(point.spread_l_per_min, 4),
                    number_or_failed(point.speed_max_cm_per_s, 1),
                    number_or_failed(point.clearance_min_mm, 3), std::to_string(point.periods),
                    point.periodic ? "yes" : "no", decimals(point.seconds.at("total"), 1)});
    if (report.measured != nullptr) {
      const auto flow = measured_flow(*report.measured, point.head_mmHg);
      rows.back().push_back(flow ? decimals(*flow, 3) : "-");
    }
  }
  return text_table(header, rows);
}

std::string scene_curve_json(const SceneReport& report) {
  const Scene& scene = report.scene;
  nlohmann::ordered_json result = {{"scene", scene.name},
                                   {"unknowns", report.unknowns},
                                   {"frequency_Hz", scene.operating_point.frequency},
                                   {"stroke_mm", stroke_mm(scene)},
                                   {"seconds", report.seconds},
                                   {"preparation_seconds", nlohmann::ordered_json::object()},
                                   {"points", nlohmann::ordered_json::array()}};
  for (const auto& [phase, record] : report.preparation.records()) {
    result["preparation_seconds"][phase] = record.seconds;
  }
  for (const CurvePoint& point : report.points) {
    nlohmann::ordered_json entry = {{"head_mmHg", point.head_mmHg},
                                    {"flow_l_per_min", finite_or_null(point.flow_l_per_min)},
                                    {"error_l_per_min", nullptr},
                                    {"inflow_l_per_min", finite_or_null(point.inflow_l_per_min)},
                                    {"spread_l_per_min", finite_or_null(point.spread_l_per_min)},
                                    {"hydraulic_power_mW", finite_or_null(point.power_mW)},
                                    {"holder_power_mW", finite_or_null(point.holder_power_mW)},
                                    {"speed_max_cm_per_s", finite_or_null(point.speed_max_cm_per_s)},
                                    {"clearance_min_mm", finite_or_null(point.clearance_min_mm)},
                                    {"periods", point.periods},
                                    {"periodic", point.periodic},
                                    {"reason", point.reason},
                                    {"seconds", point.seconds}};
    if (report.measured != nullptr) {
      const auto flow = measured_flow(*report.measured, point.head_mmHg);
      entry["measured_l_per_min"] = flow ? nlohmann::ordered_json(*flow) : nlohmann::ordered_json(nullptr);
    }
    result["points"].push_back(std::move(entry));
  }
  return result.dump(2) + "\n";
}

SceneCurve read_scene_curve(const std::filesystem::path& file) {
  try {
    const auto json = nlohmann::json::parse(read_text_file(file));
    SceneCurve curve;
    curve.frequency_Hz = json.at("frequency_Hz").get<double>();
    curve.stroke_mm = json.at("stroke_mm").get<double>();
    curve.unknowns = json.at("unknowns").get<int>();
    double seconds = 0;
    for (const auto& [phase, spent] : json.at("preparation_seconds").items()) {
      seconds += spent.get<double>();
    }
    for (const auto& point : json.at("points")) {
      seconds += point.at("seconds").at("total").get<double>();
      if (point.at("flow_l_per_min").is_null()) {
        continue;
      }
      curve.head_mmHg.push_back(point.at("head_mmHg").get<double>());
      curve.flow_l_per_min.push_back(point.at("flow_l_per_min").get<double>());
    }
    curve.seconds_per_point =
        seconds / static_cast<double>(std::max<std::size_t>(json.at("points").size(), 1));
    return curve;
  } catch (const nlohmann::json::exception& error) {
    throw InputError("a file of full-order runs cannot be read", error.what(),
                     "what `undula hq SCENE --json` prints", file.string());
  }
}

bool plot_scene_curve(const std::filesystem::path& picture, const SceneReport& report,
                      const std::optional<SceneCurve>& other_runs) {
  std::vector<const CurvePoint*> upwards;
  for (const CurvePoint& point : report.points) {
    if (std::isfinite(point.flow_l_per_min)) {
      upwards.push_back(&point);
    }
  }
  std::ranges::stable_sort(upwards, {}, &CurvePoint::head_mmHg);
  std::vector<double> head, flow;
  for (const CurvePoint* point : upwards) {
    head.push_back(point->head_mmHg);
    flow.push_back(point->flow_l_per_min);
  }
  const double frequency_Hz = report.scene.operating_point.frequency;
  std::vector<HqPoints> point_sets;
  if (other_runs && same_setting(other_runs->frequency_Hz, frequency_Hz) &&
      same_setting(other_runs->stroke_mm, stroke_mm(report.scene))) {
    point_sets.push_back({"other full-order runs", other_runs->head_mmHg, other_runs->flow_l_per_min});
  }
  if (report.measured != nullptr) {
    point_sets.push_back({"measured", report.measured->head_mmHg, report.measured->flow_l_per_min});
  }
  const std::string title = report.scene.name + ": " + shortest(frequency_Hz) + " Hz, stroke " +
                            shortest(stroke_mm(report.scene)) + " mm";
  return plot_hq_curve(picture, title, {"full-order model", head, flow, {}, {}}, point_sets);
}

} // namespace undula
