#include "apps/output/hq_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "apps/output/plots.hpp"
#include "apps/output/text_table.hpp"

namespace undula::apps {

std::optional<double> measured_flow(const MeasuredCurve& curve, double head_mmHg) {
  if (head_mmHg < curve.head_mmHg.front() || head_mmHg > curve.head_mmHg.back()) {
    return std::nullopt;
  }
  return curve.fit(head_mmHg);
}

nlohmann::ordered_json finite_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

bool same_setting(double a, double b) { return std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b)); }

std::string hq_table(const HqReport& report) {
  std::vector<std::string> header = {"head (mmHg)", "flow (l/min)", "error (l/min)", "in training box"};
  if (report.measured != nullptr) {
    header.emplace_back("measured, fit (l/min)");
  }
  std::vector<std::vector<std::string>> rows;
  for (const rom::HqPoint& point : report.points) {
    std::vector<std::string> row = {
        decimals(point.head_mmHg, 2), decimals(point.flow_l_per_min, 3),
        std::isfinite(point.error_l_per_min) ? decimals(point.error_l_per_min, 3) : "unknown",
        point.inside_training_box ? "yes" : "no"};
    if (report.measured != nullptr) {
      const auto flow = measured_flow(*report.measured, point.head_mmHg);
      row.push_back(flow ? decimals(*flow, 3) : "-");
    }
    rows.push_back(std::move(row));
  }
  return text_table(header, rows);
}

std::string hq_json(const HqReport& report) {
  nlohmann::ordered_json result = {{"model", report.model_file},
                                   {"frequency_Hz", report.frequency_Hz},
                                   {"stroke_mm", report.stroke_mm},
                                   {"milliseconds", report.milliseconds},
                                   {"points", nlohmann::ordered_json::array()}};
  for (const rom::HqPoint& point : report.points) {
    nlohmann::ordered_json entry = {{"head_mmHg", point.head_mmHg},
                                    {"flow_l_per_min", finite_or_null(point.flow_l_per_min)},
                                    {"error_l_per_min", finite_or_null(point.error_l_per_min)},
                                    {"inside_training_box", point.inside_training_box},
                                    {"converged", point.converged}};
    if (report.measured != nullptr) {
      const auto flow = measured_flow(*report.measured, point.head_mmHg);
      entry["measured_l_per_min"] = flow ? nlohmann::ordered_json(*flow) : nlohmann::ordered_json(nullptr);
    }
    result["points"].push_back(std::move(entry));
  }
  return result.dump(2) + "\n";
}

bool plot_hq_report(const std::filesystem::path& picture, const HqReport& report, const rom::Model& model) {
  std::vector<double> head, flow, error;
  for (const rom::HqPoint& point : report.points) {
    head.push_back(point.head_mmHg);
    flow.push_back(point.flow_l_per_min);
    error.push_back(std::isfinite(point.error_l_per_min) ? point.error_l_per_min : 0.0);
  }
  std::vector<double> full_order_head, full_order_flow;
  for (const rom::ReferencePoint& run : model.references) {
    if (same_setting(run.frequency_Hz, report.frequency_Hz) &&
        same_setting(run.stroke_mm, report.stroke_mm)) {
      full_order_head.push_back(run.head_mmHg);
      full_order_flow.push_back(run.flow_l_per_min);
    }
  }
  std::vector<HqPoints> point_sets = {{"full-order model", full_order_head, full_order_flow}};
  if (report.measured != nullptr) {
    point_sets.push_back({"measured", report.measured->head_mmHg, report.measured->flow_l_per_min});
  }
  const std::string title =
      shortest(report.frequency_Hz) + " Hz, stroke " + shortest(report.stroke_mm) + " mm";
  return plot_hq_curve(picture, title, {"reduced model", head, flow, error, "error estimate"}, point_sets);
}

} // namespace undula::apps
