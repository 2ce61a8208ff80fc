#include "apps/output/curve_report.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "apps/output/plots.hpp"
#include "apps/output/text_table.hpp"
#include "fom/scene/operating_point.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::apps {
namespace {

double stroke_mm(const Scene& scene) { return units::length_to_mm(scene.operating_point.stroke); }

std::string number_or(double value, int count, const char* otherwise) {
  return std::isfinite(value) ? decimals(value, count) : otherwise;
}

/// A column of numbers that some levels know.
struct Column {
  const char* title;
  double CurvePoint::*value;
  int decimals;
  const char* otherwise;
};
constexpr Column columns[] = {{"error (l/min)", &CurvePoint::error_l_per_min, 3, "unknown"},
                              {"inflow (l/min)", &CurvePoint::inflow_l_per_min, 4, "failed"},
                              {"spread (l/min)", &CurvePoint::spread_l_per_min, 4, "failed"},
                              {"standard error (l/min)", &CurvePoint::standard_error_l_per_min, 4, "-"},
                              {"max speed (cm/s)", &CurvePoint::speed_max_cm_per_s, 1, "failed"},
                              {"min clearance (mm)", &CurvePoint::clearance_min_mm, 3, "failed"},
                              {"film < 4 elements (%)", &CurvePoint::film_unresolved_percent, 0, "failed"}};

/// Of a holder that is free to move.
constexpr Column drive_columns[] = {
    {"stroke (mm)", &CurvePoint::stroke_mm, 4, "failed"},
    {"at 2 f (mm)", &CurvePoint::stroke_2f_mm, 4, "failed"},
    {"at 3 f (mm)", &CurvePoint::stroke_3f_mm, 4, "failed"},
    {"phase (degrees)", &CurvePoint::phase_degrees, 1, "failed"},
    {"offset (mm)", &CurvePoint::offset_mm, 4, "failed"},
    {"reaction in phase (N/mm)", &CurvePoint::reaction_in_phase_N_per_mm, 2, "failed"},
    {"in quadrature (N/mm)", &CurvePoint::reaction_quadrature_N_per_mm, 2, "failed"},
    {"actuator (mW)", &CurvePoint::actuator_power_mW, 0, "failed"},
    {"electrical (mW)", &CurvePoint::electrical_power_mW, 0, "failed"},
    {"efficiency (%)", &CurvePoint::efficiency_percent, 1, "failed"}};

/// Of a peristaltic pump.
constexpr Column hose_columns[] = {
    {"per turn (ml)", &CurvePoint::flow_per_turn_ml, 3, "failed"},
    {"ripple (l/min)", &CurvePoint::ripple_l_per_min, 4, "failed"},
    {"leak (l/min)", &CurvePoint::leak_l_per_min, 4, "failed"},
    {"torque (N m)", &CurvePoint::torque_N_m, 4, "failed"},
    {"max torque (N m)", &CurvePoint::torque_max_N_m, 4, "failed"},
    {"roller power (mW)", &CurvePoint::holder_power_mW, 1, "failed"},
    {"efficiency (%)", &CurvePoint::efficiency_percent, 1, "failed"},
    {"max roller force (N)", &CurvePoint::roller_force_max_N, 1, "failed"},
    {"min outlet pressure (mmHg)", &CurvePoint::outlet_pressure_min_mmHg, 2, "failed"},
    {"max outlet pressure (mmHg)", &CurvePoint::outlet_pressure_max_mmHg, 2, "failed"}};

/// Whether any point knows it; an infinite error is known to be unknown.
bool is_known(const Column& column, std::span<const CurvePoint> points) {
  return std::ranges::any_of(points,
                             [&](const CurvePoint& point) { return !std::isnan(point.*column.value); });
}

bool has_training_box(std::span<const CurvePoint> points) {
  return std::ranges::any_of(points, [](const auto& point) { return point.inside_training_box.has_value(); });
}

double total_seconds(const CurvePoint& point) {
  const auto found = point.seconds.find("total");
  return found == point.seconds.end() ? CurvePoint::unknown : found->second;
}

/// Places of the points with a flow, from the lowest head to the highest.
std::vector<std::size_t> upwards(std::span<const CurvePoint> points) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::isfinite(points[i].flow_l_per_min)) {
      order.push_back(i);
    }
  }
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return points[i].head_mmHg; });
  return order;
}

} // namespace

std::optional<double> measured_flow(const MeasuredCurve& curve, double head_mmHg) {
  if (head_mmHg < curve.head_mmHg.front() || head_mmHg > curve.head_mmHg.back()) {
    return std::nullopt;
  }
  return curve.fit(head_mmHg);
}

nlohmann::ordered_json finite_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

std::string curve_table(const CurveReport& report) {
  std::vector<std::string> header = {"head (mmHg)", "flow (l/min)"};
  std::vector<Column> shown;
  std::ranges::copy_if(columns, std::back_inserter(shown),
                       [&](const Column& column) { return is_known(column, report.points); });
  if (report.scene.operating_point.drive == Drive::voltage) {
    std::ranges::copy_if(drive_columns, std::back_inserter(shown),
                         [&](const Column& column) { return is_known(column, report.points); });
  }
  if (report.scene.operating_point.drive == Drive::rollers) {
    std::ranges::copy_if(hose_columns, std::back_inserter(shown),
                         [&](const Column& column) { return is_known(column, report.points); });
  }
  for (const Column& column : shown) {
    header.emplace_back(column.title);
  }
  const bool boxed = has_training_box(report.points);
  if (boxed) {
    header.emplace_back("in training box");
  }
  const bool tiers =
      std::ranges::any_of(report.points, [](const auto& point) { return !point.tier.empty(); });
  if (tiers) {
    header.emplace_back("answered by");
  }
  header.insert(header.end(), {"periods", "periodic", "seconds"});
  if (report.measured != nullptr) {
    header.emplace_back("measured, fit (l/min)");
  }
  if (report.band != nullptr) {
    if (report.band->posterior) {
      header.insert(header.end(), {"band, data given (l/min)", "of samples (l/min)"});
    } else {
      header.emplace_back("by tolerances (l/min)");
    }
  }
  if (!report.beside.empty()) {
    header.emplace_back(report.beside_level + " (l/min)");
  }
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 0; i < report.points.size(); ++i) {
    const CurvePoint& point = report.points[i];
    std::vector<std::string> row = {decimals(point.head_mmHg, 2),
                                    number_or(point.flow_l_per_min, 4, "failed")};
    for (const Column& column : shown) {
      row.push_back(number_or(point.*column.value, column.decimals, column.otherwise));
    }
    if (boxed) {
      row.emplace_back(!point.inside_training_box ? "-" : *point.inside_training_box ? "yes" : "no");
    }
    if (tiers) {
      row.push_back(point.tier);
    }
    row.insert(row.end(), {point.periods == 0 ? "-" : std::to_string(point.periods),
                           point.periodic ? "yes" : "no", number_or(total_seconds(point), 3, "-")});
    if (report.measured != nullptr) {
      const auto flow = measured_flow(*report.measured, point.head_mmHg);
      row.push_back(flow ? decimals(*flow, 3) : "-");
    }
    if (report.band != nullptr) {
      const double width = report.band->half_width(i);
      row.push_back(std::isfinite(width) ? "-+" + decimals(width, 3) : "unknown");
      if (report.band->posterior) {
        row.push_back("-+" + decimals(report.band->half_width_of_samples(i), 3));
      }
    }
    if (!report.beside.empty()) {
      row.push_back(number_or(report.beside[i].flow_l_per_min, 4, "failed"));
    }
    rows.push_back(std::move(row));
  }
  return text_table(header, rows);
}

std::string sensitivity_table(const CurveReport& report) {
  // 1. The lowest, middle and highest head.
  std::vector<std::size_t> upwards(report.points.size());
  std::iota(upwards.begin(), upwards.end(), std::size_t{0});
  std::ranges::stable_sort(upwards, {}, [&](std::size_t i) { return report.points[i].head_mmHg; });
  std::vector<std::size_t> shown = {upwards.front(), upwards[upwards.size() / 2], upwards.back()};
  shown.erase(std::unique(shown.begin(), shown.end()), shown.end());

  // 2. One row per input: change of the flow at value + tolerance / value - tolerance.
  std::vector<std::string> header = {"input", "value", "tolerance"};
  for (const std::size_t i : shown) {
    header.push_back("+/- at " + plain_number(report.points[i].head_mmHg) + " mmHg (l/min)");
  }
  const auto signed_number = [](double value) {
    return std::isfinite(value) ? (value >= 0 ? "+" : "") + decimals(value, 3) : std::string("unknown");
  };
  std::vector<std::vector<std::string>> rows;
  std::string notes;
  for (const InputEffect& input : report.band->tolerances.inputs) {
    rows.push_back({input.key, plain_number(input.value), plain_number(input.tolerance)});
    for (const std::size_t i : shown) {
      rows.back().push_back(signed_number(input.up[i]) + " / " + signed_number(input.down[i]));
    }
    if (!input.note.empty()) {
      notes += input.key + ": one side alone where the other is unknown (" + input.note + ")\n";
    }
  }
  return text_table(header, rows) + notes;
}

namespace {

nlohmann::ordered_json point_json(const CurvePoint& point) {
  nlohmann::ordered_json entry = {{"head_mmHg", point.head_mmHg},
                                  {"flow_l_per_min", finite_or_null(point.flow_l_per_min)},
                                  {"error_l_per_min", finite_or_null(point.error_l_per_min)}};
  if (point.inside_training_box) {
    entry["inside_training_box"] = *point.inside_training_box;
  }
  entry["inflow_l_per_min"] = finite_or_null(point.inflow_l_per_min);
  entry["spread_l_per_min"] = finite_or_null(point.spread_l_per_min);
  entry["standard_error_l_per_min"] = finite_or_null(point.standard_error_l_per_min);
  entry["averaged_periods"] = point.averaged_periods;
  entry["hydraulic_power_mW"] = finite_or_null(point.power_mW);
  entry["holder_power_mW"] = finite_or_null(point.holder_power_mW);
  entry["holder"] = {{"stroke_mm", finite_or_null(point.stroke_mm)},
                     {"stroke_2f_mm", finite_or_null(point.stroke_2f_mm)},
                     {"stroke_3f_mm", finite_or_null(point.stroke_3f_mm)},
                     {"phase_degrees", finite_or_null(point.phase_degrees)},
                     {"phase_2f_degrees", finite_or_null(point.phase_2f_degrees)},
                     {"phase_3f_degrees", finite_or_null(point.phase_3f_degrees)},
                     {"offset_mm", finite_or_null(point.offset_mm)},
                     {"reaction_in_phase_N_per_mm", finite_or_null(point.reaction_in_phase_N_per_mm)},
                     {"reaction_quadrature_N_per_mm", finite_or_null(point.reaction_quadrature_N_per_mm)},
                     {"actuator_power_mW", finite_or_null(point.actuator_power_mW)},
                     {"electrical_power_mW", finite_or_null(point.electrical_power_mW)},
                     {"efficiency_percent", finite_or_null(point.efficiency_percent)}};
  entry["speed_max_cm_per_s"] = finite_or_null(point.speed_max_cm_per_s);
  entry["clearance_min_mm"] = finite_or_null(point.clearance_min_mm);
  if (std::isfinite(point.torque_N_m)) {
    entry["rollers"] = {{"flow_per_turn_ml", finite_or_null(point.flow_per_turn_ml)},
                        {"ripple_l_per_min", finite_or_null(point.ripple_l_per_min)},
                        {"leak_l_per_min", finite_or_null(point.leak_l_per_min)},
                        {"torque_N_m", point.torque_N_m},
                        {"torque_max_N_m", finite_or_null(point.torque_max_N_m)},
                        {"force_max_N", finite_or_null(point.roller_force_max_N)},
                        {"outlet_pressure_min_mmHg", finite_or_null(point.outlet_pressure_min_mmHg)},
                        {"outlet_pressure_max_mmHg", finite_or_null(point.outlet_pressure_max_mmHg)}};
  }
  if (std::isfinite(point.scalar_stress_max_Pa)) {
    entry["blood"] = {{"haemolysis_percent", finite_or_null(point.haemolysis_percent)},
                      {"scalar_stress_max_Pa", point.scalar_stress_max_Pa},
                      {"stressed_volume_mm3", point.stressed_volume_mm3}};
  }
  if (std::isfinite(point.film_unresolved_percent)) {
    entry["film"] = {{"elements_min", point.film_elements_min},
                     {"unresolved_percent", point.film_unresolved_percent}};
  }
  if (!point.tier.empty()) {
    entry["tier"] = point.tier;
    entry["why"] = point.why;
  }
  entry["periods"] = point.periods;
  entry["periodic"] = point.periodic;
  entry["reason"] = point.reason;
  entry["seconds"] = point.seconds;
  return entry;
}

nlohmann::ordered_json tolerances_json(const UncertaintyBand& band) {
  const auto list = [](std::span<const double> values) {
    auto numbers = nlohmann::ordered_json::array();
    for (const double value : values) {
      numbers.push_back(finite_or_null(value));
    }
    return numbers;
  };
  auto tolerances = nlohmann::ordered_json::array();
  for (const InputEffect& input : band.inputs) {
    tolerances.push_back({{"key", input.key},
                          {"value", input.value},
                          {"tolerance", input.tolerance},
                          {"plus_l_per_min", list(input.up)},
                          {"minus_l_per_min", list(input.down)},
                          {"note", input.note}});
  }
  return tolerances;
}

} // namespace

namespace {

nlohmann::ordered_json report_json(const CurveReport& report) {
  const Scene& scene = report.scene;
  nlohmann::ordered_json result = {{"scene", scene.name}, {"level", report.level}};
  if (!report.model_file.empty()) {
    result = {{"model", report.model_file}, {"level", report.level}};
  }
  result["unknowns"] = report.unknowns;
  result["frequency_Hz"] = scene.operating_point.frequency;
  if (scene.operating_point.drive == Drive::voltage) {
    result["voltage_V"] = scene.operating_point.voltage;
  } else if (scene.operating_point.drive == Drive::stroke) {
    result["stroke_mm"] = stroke_mm(scene);
  }
  result["seconds"] = report.seconds;
  result["preparation_seconds"] = nlohmann::ordered_json::object();
  for (const auto& [phase, record] : report.preparation.records()) {
    result["preparation_seconds"][phase] = record.seconds;
  }
  result["points"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < report.points.size(); ++i) {
    const CurvePoint& point = report.points[i];
    nlohmann::ordered_json entry = point_json(point);
    if (report.measured != nullptr) {
      const auto flow = measured_flow(*report.measured, point.head_mmHg);
      entry["measured_l_per_min"] = flow ? nlohmann::ordered_json(*flow) : nlohmann::ordered_json(nullptr);
    }
    if (report.band != nullptr) {
      entry["error_l_per_min"] = finite_or_null(report.band->half_width(i));
      if (report.band->posterior) {
        entry["error_of_samples_l_per_min"] = finite_or_null(report.band->half_width_of_samples(i));
      } else {
        entry["error_low_l_per_min"] = finite_or_null(report.band->tolerances.low[i]);
        entry["error_high_l_per_min"] = finite_or_null(report.band->tolerances.high[i]);
      }
    }
    if (!report.beside.empty()) {
      entry["beside"] = point_json(report.beside[i]);
      entry["beside"]["level"] = report.beside_level;
    }
    result["points"].push_back(std::move(entry));
  }
  if (report.band != nullptr) {
    result["tolerances"] = tolerances_json(report.band->tolerances);
    if (report.band->posterior) {
      result["given_data"] = posterior_json(*report.band);
    }
  }
  return result;
}

} // namespace

std::string curves_json(std::span<const CurveReport> reports) {
  if (reports.size() == 1) {
    return report_json(reports.front()).dump(2) + "\n";
  }
  nlohmann::ordered_json all = {{"curves", nlohmann::ordered_json::array()}};
  for (const CurveReport& report : reports) {
    all["curves"].push_back(report_json(report));
  }
  return all.dump(2) + "\n";
}

namespace {

/// Numbers of a report in the order of its heads, for a picture.
struct DrawnCurve {
  std::vector<double> head, flow, error, beside_head, beside_flow;
};

DrawnCurve drawn(const CurveReport& report) {
  const auto finite_or_zero = [](double value) { return std::isfinite(value) ? value : 0.0; };
  DrawnCurve curve;
  for (const std::size_t i : upwards(report.points)) {
    const CurvePoint& point = report.points[i];
    curve.head.push_back(point.head_mmHg);
    curve.flow.push_back(point.flow_l_per_min);
    if (report.band != nullptr) {
      curve.error.push_back(finite_or_zero(report.band->posterior ? report.band->half_width_of_samples(i)
                                                                  : report.band->half_width(i)));
    } else if (!std::isnan(point.error_l_per_min)) {
      curve.error.push_back(finite_or_zero(point.error_l_per_min));
    }
  }
  if (curve.error.size() != curve.flow.size()) {
    curve.error.clear();
  }
  for (const std::size_t i : upwards(report.beside)) {
    curve.beside_head.push_back(report.beside[i].head_mmHg);
    curve.beside_flow.push_back(report.beside[i].flow_l_per_min);
  }
  return curve;
}

std::string band_label(const CurveReport& report) {
  if (report.band == nullptr) {
    return "error estimate";
  }
  return report.band->posterior ? "95 % of samples" : "by tolerances of the inputs (95 %)";
}

} // namespace

bool plot_curve_reports(const std::filesystem::path& picture, std::span<const CurveReport> reports) {
  std::vector<DrawnCurve> curves;
  curves.reserve(reports.size());
  for (const CurveReport& report : reports) {
    curves.push_back(drawn(report));
  }
  const bool several = reports.size() > 1;
  std::vector<HqLine> lines;
  std::vector<HqPoints> point_sets;
  for (std::size_t k = 0; k < reports.size(); ++k) {
    const CurveReport& report = reports[k];
    const DrawnCurve& curve = curves[k];
    const int line = several ? static_cast<int>(k) : -1;
    const std::string setting = setting_text(report.scene.operating_point),
                      at = several ? ", " + setting : "";
    lines.push_back(
        {several ? setting : report.level, curve.head, curve.flow, curve.error, band_label(report) + at});
    if (!curve.beside_flow.empty()) {
      point_sets.push_back({report.beside_level, curve.beside_head, curve.beside_flow, true, line});
    }
    for (const RecordedCurve& runs : report.recorded) {
      if (same_setting(runs.frequency_Hz, report.scene.operating_point.frequency) &&
          same_setting(runs.stroke_mm, stroke_mm(report.scene))) {
        point_sets.push_back({"recorded runs" + at, runs.head_mmHg, runs.flow_l_per_min, false, line});
      }
    }
    if (report.measured != nullptr) {
      point_sets.push_back(
          {"measured" + at, report.measured->head_mmHg, report.measured->flow_l_per_min, false, line});
    }
  }
  const std::string title =
      reports.front().scene.name + ": " +
      (several ? reports.front().level : setting_text(reports.front().scene.operating_point));
  return plot_hq_curves(picture, title, lines, point_sets);
}

} // namespace undula::apps
