#include "rom/curve/stated_drive.hpp"

#include <cmath>

#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::rom {

double drive_of(const StatedDrive& stated, bool by_voltage, const std::string& model,
                const std::string& where) {
  const std::string name = by_voltage ? "voltage" : "stroke", unit = by_voltage ? "V" : "mm";
  const auto& drive = by_voltage ? stated.voltage_V : stated.stroke_mm;
  const auto& other = by_voltage ? stated.stroke_mm : stated.voltage_V;
  if (!drive || other) {
    std::string seen = drive ? "a " + name : "no " + name;
    if (other)
      seen += (drive ? " and a " : ", but a ") + std::string(by_voltage ? "stroke" : "voltage") + " of " +
              plain_number(*other) + (by_voltage ? " mm" : " V");
    throw InputError(model + " is driven by a " + name, seen, "a " + name + " (" + unit + ") alone", where);
  }
  if (!std::isfinite(*drive) || *drive <= 0)
    throw InputError("no operating point: the " + name, plain_number(*drive) + " " + unit,
                     "a finite number > 0", where);
  return *drive;
}

double stroke_of_scenes(double stroke_mm) { return units::length_to_mm(units::length_from_mm(stroke_mm)); }

} // namespace undula::rom
