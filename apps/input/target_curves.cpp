#include "apps/input/target_curves.hpp"

#include "apps/input/head_list.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::apps {
namespace {

/// Frequency or stroke of a measured curve: as given, else as the file states it.
double setting(const std::optional<double>& option_value, const std::optional<double>& stated,
               const char* key, const char* option, const std::string& file) {
  if (!option_value && !stated) {
    throw InputError("the data do not state how the pump was driven", std::string("no ") + key,
                     std::string("a line # ") + key + " = ... before the columns, or " + option +
                         " where there is one file",
                     file);
  }
  return option_value ? *option_value : *stated;
}

} // namespace

std::vector<TargetCurve> target_curves(const Scene& scene, std::span<const std::string> files,
                                       std::span<const MeasuredCurve> measured, const DataSetting& given,
                                       int points) {
  const bool by_voltage = scene.operating_point.drive == Drive::voltage;
  if (by_voltage && given.stroke_mm) {
    throw InputError("a voltage drives the scene", "--stroke " + plain_number(*given.stroke_mm),
                     "--voltage, or operating_point.drive = \"stroke\"", "--stroke");
  }
  if (!by_voltage && given.voltage_V) {
    throw InputError("a stroke drives the scene", "--voltage " + plain_number(*given.voltage_V),
                     "--stroke, or operating_point.drive = \"voltage\"", "--voltage");
  }
  if (files.size() > 1 && (given.frequency_Hz || given.stroke_mm || given.voltage_V)) {
    throw InputError("one frequency, stroke or voltage cannot serve several data files",
                     std::to_string(files.size()) + " files with --frequency, --stroke or --voltage",
                     "one file, or files that state both themselves", "--data");
  }
  std::vector<TargetCurve> targets;
  for (std::size_t c = 0; c < measured.size(); ++c) {
    const MeasuredCurve& curve = measured[c];
    TargetCurve target;
    target.name = files[c];
    target.frequency_Hz =
        setting(given.frequency_Hz, curve.frequency_Hz, "frequency_Hz", "--frequency", target.name);
    OperatingPoint asked = scene.operating_point;
    asked.frequency = target.frequency_Hz;
    if (by_voltage) {
      target.voltage_V = setting(given.voltage_V, curve.voltage_V, "voltage_V", "--voltage", target.name);
      asked.voltage = target.voltage_V;
    } else {
      target.stroke_mm = setting(given.stroke_mm, curve.stroke_mm, "stroke_mm", "--stroke", target.name);
      asked.stroke = units::length_from_mm(target.stroke_mm);
    }
    warn_of_other_point(curve, target.name, "the command line", asked);
    target.head_mmHg = even_heads(curve.head_mmHg.front(), curve.head_mmHg.back(), points);
    for (const double head : target.head_mmHg) {
      target.flow_l_per_min.push_back(curve.fit(head));
    }
    target.scatter_l_per_min = curve.fit.scatter_l_per_min;
    targets.push_back(std::move(target));
  }
  return targets;
}

} // namespace undula::apps
