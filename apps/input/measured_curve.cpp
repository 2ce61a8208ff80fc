#include "apps/input/measured_curve.hpp"

#include <spdlog/spdlog.h>

#include <cmath>
#include <optional>

#include "fom/scene/operating_point.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::apps {

std::string other_operating_point(const MeasuredCurve& curve, const std::string& file,
                                  const std::string& what, const OperatingPoint& point) {
  const auto differs = [](const std::optional<double>& stated, double asked) {
    return stated && std::abs(*stated - asked) > 1e-6 * std::abs(asked);
  };
  const bool by_voltage = point.drive == Drive::voltage;
  const auto& drive = by_voltage ? curve.voltage_V : curve.stroke_mm;
  if (!differs(curve.frequency_Hz, point.frequency) &&
      !differs(drive, by_voltage ? point.voltage : units::length_to_mm(point.stroke))) {
    return "";
  }
  const auto stated = [](const std::optional<double>& value, const char* unit) {
    return (value ? exact_number(*value) : std::string("unstated")) + unit;
  };
  return file + " was measured at another operating point: " + stated(curve.frequency_Hz, " Hz") +
         (by_voltage ? ", " : ", stroke ") + stated(drive, by_voltage ? " V" : " mm") + "; " + what +
         " has " + setting_text(point);
}

void warn_of_other_point(const MeasuredCurve& curve, const std::string& file, const std::string& what,
                         const OperatingPoint& point) {
  const std::string sentence = other_operating_point(curve, file, what, point);
  if (!sentence.empty()) {
    spdlog::warn("{}", sentence);
  }
}

} // namespace undula::apps
