#include "apps/input/recorded_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"

namespace undula::apps {

RecordedCurve read_recorded_curve(const std::filesystem::path& file) {
  try {
    const auto json = nlohmann::json::parse(read_text_file(file));
    RecordedCurve curve;
    curve.frequency_Hz = json.at("frequency_Hz").get<double>();
    curve.stroke_mm = json.value("stroke_mm", std::numeric_limits<double>::quiet_NaN()); // NaN: by a voltage
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
    throw InputError("a file of recorded runs cannot be read", error.what(),
                     "what `undula hq FILE --json` prints", file.string());
  }
}

RecordedCurve kept_runs(const rom::Model& model, double frequency_Hz, double stroke_mm) {
  RecordedCurve curve;
  curve.frequency_Hz = frequency_Hz;
  curve.stroke_mm = stroke_mm;
  for (const rom::ReferencePoint& run : model.references) {
    if (same_setting(run.frequency_Hz, frequency_Hz) && same_setting(run.stroke_mm, stroke_mm)) {
      curve.head_mmHg.push_back(run.head_mmHg);
      curve.flow_l_per_min.push_back(run.flow_l_per_min);
    }
  }
  return curve;
}

bool same_setting(double a, double b) { return std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b)); }

} // namespace undula::apps
