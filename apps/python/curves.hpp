// A head-flow curve as Python sees it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rom/curve/curve_point.hpp"
#include "rom/curve/stated_drive.hpp"

namespace undula::python {

struct Curve {
  std::string level; ///< what computed: "reduced model", "emulator"
  double frequency_Hz = 0;
  rom::StatedDrive drive; ///< one of the two
  std::vector<rom::CurvePoint> points;
  std::vector<std::string> remarks; ///< what has to be known before it is believed
};

} // namespace undula::python
