#include "apps/output/scene_curve.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "apps/output/hq_report.hpp"
#include "apps/output/plots.hpp"
#include "apps/output/text_table.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::apps {
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
  if (report.band != nullptr) {
    header.emplace_back("by tolerances (l/min)");
  }
  if (!report.reduced.empty()) {
    header.emplace_back("reduced model (l/min)");
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
    if (report.band != nullptr) {
      const double width = report.band->half_width[rows.size() - 1];
      rows.back().push_back(std::isfinite(width) ? "-+" + decimals(width, 3) : "unknown");
    }
    if (!report.reduced.empty()) {
      rows.back().push_back(decimals(report.reduced[rows.size() - 1].flow_l_per_min, 3));
    }
  }
  return text_table(header, rows);
}

std::string sensitivity_table(const SceneReport& report) {
  // 1. The lowest, middle and highest head.
  std::vector<std::size_t> upwards(report.points.size());
  std::iota(upwards.begin(), upwards.end(), std::size_t{0});
  std::ranges::stable_sort(upwards, {}, [&](std::size_t i) { return report.points[i].head_mmHg; });
  std::vector<std::size_t> shown = {upwards.front(), upwards[upwards.size() / 2], upwards.back()};
  shown.erase(std::unique(shown.begin(), shown.end()), shown.end());

  // 2. One row per input: change of the flow at value + tolerance / value - tolerance.
  std::vector<std::string> header = {"input", "value", "tolerance"};
  for (const std::size_t i : shown) {
    header.push_back("+/- at " + shortest(report.points[i].head_mmHg) + " mmHg (l/min)");
  }
  const auto signed_number = [](double value) {
    return std::isfinite(value) ? (value >= 0 ? "+" : "") + decimals(value, 3) : std::string("unknown");
  };
  std::vector<std::vector<std::string>> rows;
  std::string notes;
  for (const InputEffect& input : report.band->inputs) {
    rows.push_back({input.key, shortest(input.value), shortest(input.tolerance)});
    for (const std::size_t i : shown) {
      rows.back().push_back(signed_number(input.up[i]) + " / " + signed_number(input.down[i]));
    }
    if (!input.note.empty()) {
      notes += input.key + ": one side alone where the other is unknown (" + input.note + ")\n";
    }
  }
  return text_table(header, rows) + notes;
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
  for (std::size_t i = 0; i < report.points.size(); ++i) {
    const CurvePoint& point = report.points[i];
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
    if (report.band != nullptr) {
      entry["error_l_per_min"] = finite_or_null(report.band->half_width[i]);
      entry["error_low_l_per_min"] = finite_or_null(report.band->low[i]);
      entry["error_high_l_per_min"] = finite_or_null(report.band->high[i]);
    }
    if (!report.reduced.empty()) {
      entry["reduced_model"] = {{"flow_l_per_min", report.reduced[i].flow_l_per_min},
                                {"error_l_per_min", finite_or_null(report.reduced[i].error_l_per_min)},
                                {"inside_training_box", report.reduced[i].inside_training_box}};
    }
    result["points"].push_back(std::move(entry));
  }
  if (report.band != nullptr) {
    const auto list = [](std::span<const double> values) {
      auto numbers = nlohmann::ordered_json::array();
      for (const double value : values) {
        numbers.push_back(finite_or_null(value));
      }
      return numbers;
    };
    result["tolerances"] = nlohmann::ordered_json::array();
    for (const InputEffect& input : report.band->inputs) {
      result["tolerances"].push_back({{"key", input.key},
                                      {"value", input.value},
                                      {"tolerance", input.tolerance},
                                      {"plus_l_per_min", list(input.up)},
                                      {"minus_l_per_min", list(input.down)},
                                      {"note", input.note}});
    }
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
  std::vector<std::size_t> upwards;
  for (std::size_t i = 0; i < report.points.size(); ++i) {
    if (std::isfinite(report.points[i].flow_l_per_min)) {
      upwards.push_back(i);
    }
  }
  std::ranges::stable_sort(upwards, {}, [&](std::size_t i) { return report.points[i].head_mmHg; });
  std::vector<double> head, flow, error;
  for (const std::size_t i : upwards) {
    head.push_back(report.points[i].head_mmHg);
    flow.push_back(report.points[i].flow_l_per_min);
    if (report.band != nullptr) {
      error.push_back(std::isfinite(report.band->half_width[i]) ? report.band->half_width[i] : 0.0);
    }
  }
  const double frequency_Hz = report.scene.operating_point.frequency;
  std::vector<HqPoints> point_sets;
  std::vector<double> reduced;
  for (const std::size_t i : upwards) {
    if (!report.reduced.empty()) {
      reduced.push_back(report.reduced[i].flow_l_per_min);
    }
  }
  if (!reduced.empty()) {
    point_sets.push_back({"reduced model", head, reduced, true});
  }
  if (other_runs && same_setting(other_runs->frequency_Hz, frequency_Hz) &&
      same_setting(other_runs->stroke_mm, stroke_mm(report.scene))) {
    point_sets.push_back({"other full-order runs", other_runs->head_mmHg, other_runs->flow_l_per_min});
  }
  if (report.measured != nullptr) {
    point_sets.push_back({"measured", report.measured->head_mmHg, report.measured->flow_l_per_min});
  }
  const std::string title = report.scene.name + ": " + shortest(frequency_Hz) + " Hz, stroke " +
                            shortest(stroke_mm(report.scene)) + " mm";
  const char* label = report.scene.space == Space::thin_gap ? "thin-gap model" : "full-order model";
  return plot_hq_curve(picture, title, {label, head, flow, error, "by tolerances of the inputs (95 %)"},
                       point_sets);
}

} // namespace undula::apps
