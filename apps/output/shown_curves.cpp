#include "apps/output/shown_curves.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <vector>

#include "apps/output/plots.hpp"
#include "apps/output/text_table.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"

namespace undula::apps {
namespace {

/// One curve, upwards in the head.
struct ShownCurve {
  std::string name, level, setting, band_label, beside_level;
  std::vector<double> head, flow, error, beside_head, beside_flow;
};

double number_or_nan(const nlohmann::json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

ShownCurve curve_of(const nlohmann::json& json) {
  ShownCurve curve;
  curve.level = json.at("level").get<std::string>();
  curve.name = json.contains("scene")
                   ? json.at("scene").get<std::string>()
                   : std::filesystem::path(json.at("model").get<std::string>()).stem().string();
  curve.setting = plain_number(json.at("frequency_Hz").get<double>()) + " Hz";
  if (json.contains("voltage_V")) {
    curve.setting += ", " + plain_number(json.at("voltage_V").get<double>()) + " V";
  } else if (json.contains("stroke_mm")) {
    curve.setting += ", stroke " + plain_number(json.at("stroke_mm").get<double>()) + " mm";
  }
  curve.band_label = json.contains("given_data")   ? "95 % of samples"
                     : json.contains("tolerances") ? "by tolerances of the inputs (95 %)"
                                                   : "error estimate";
  const auto& points = json.at("points");
  std::vector<std::size_t> upwards(points.size());
  std::iota(upwards.begin(), upwards.end(), 0);
  std::ranges::stable_sort(upwards, {},
                           [&](std::size_t i) { return points[i].at("head_mmHg").get<double>(); });
  for (const std::size_t i : upwards) {
    const auto& point = points[i];
    curve.head.push_back(point.at("head_mmHg").get<double>());
    curve.flow.push_back(number_or_nan(point.at("flow_l_per_min")));
    const char* half_width =
        point.contains("error_of_samples_l_per_min") ? "error_of_samples_l_per_min" : "error_l_per_min";
    // An error that is unknown beside known ones: no band at this head.
    const double error = number_or_nan(point.value(half_width, nlohmann::json()));
    curve.error.push_back(std::isfinite(error) ? error : 0.0);
    if (point.contains("beside")) {
      curve.beside_level = point.at("beside").at("level").get<std::string>();
      curve.beside_head.push_back(curve.head.back());
      curve.beside_flow.push_back(number_or_nan(point.at("beside").at("flow_l_per_min")));
    }
  }
  if (std::ranges::all_of(curve.error, [](double error) { return error == 0; })) {
    curve.error.clear();
  }
  return curve;
}

} // namespace

bool show_curves(const std::filesystem::path& file, std::span<const MeasuredCurve> measured,
                 const std::filesystem::path& picture) {
  std::vector<ShownCurve> curves;
  try {
    const auto json = nlohmann::json::parse(read_text_file(file));
    if (json.contains("curves")) {
      for (const auto& one : json.at("curves")) {
        curves.push_back(curve_of(one));
      }
    } else {
      curves.push_back(curve_of(json));
    }
  } catch (const nlohmann::json::exception& error) {
    throw InputError("a file of curves cannot be read", error.what(), "what `undula hq FILE --json` prints",
                     file.string());
  }
  if (curves.empty()) {
    throw InputError("a file of curves holds none", "an empty list", "what `undula hq FILE --json` prints",
                     file.string());
  }
  const bool several = curves.size() > 1;
  std::vector<HqLine> lines;
  std::vector<HqPoints> point_sets;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const ShownCurve& curve = curves[k];
    lines.push_back({several ? curve.setting : curve.level, curve.head, curve.flow, curve.error,
                     curve.band_label + (several ? ", " + curve.setting : "")});
    if (!curve.beside_flow.empty()) {
      point_sets.push_back({curve.beside_level, curve.beside_head, curve.beside_flow, true,
                            several ? static_cast<int>(k) : -1});
    }
  }
  for (const MeasuredCurve& samples : measured) {
    point_sets.push_back({"measured", samples.head_mmHg, samples.flow_l_per_min, false, -1});
  }
  const ShownCurve& first = curves.front();
  return plot_hq_curves(picture, first.name + ": " + (several ? first.level : first.setting), lines,
                        point_sets);
}

} // namespace undula::apps
