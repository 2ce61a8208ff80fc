// Numbers of a curve's points by name, for callers in other languages.
#pragma once

#include <span>

#include "rom/curve/curve_point.hpp"

namespace undula::rom {

/// The name carries the unit.
struct CurveColumn {
  const char* name;
  double CurvePoint::*value;
  const char* help;
};

/// All that models of rom/ may know, head and flow first.
std::span<const CurveColumn> curve_columns();

} // namespace undula::rom
