// The bore of a hose that is pressed flat: a stadium whose outline keeps its length.
//
//      ___________
//     (___________)  h      width = pi (a - h/2) of the flat part, area = pi h (a - h/4)
//
// a: radius of the open bore, where h = 2 a.
#pragma once

#include <algorithm>
#include <numbers>

namespace undula::geometry {

/// Area of the bore at height `h` in [0, 2 a], cm^2.
inline double flattened_area(double a, double h) { return std::numbers::pi * h * (a - 0.25 * h); }

/// Width of its flat part, cm. It is the derivative of the area by the height as well.
inline double flattened_width(double a, double h) { return std::numbers::pi * std::max(a - 0.5 * h, 0.0); }

/// Hydraulic diameter, cm: the outline is 2 pi a long at any height.
inline double flattened_hydraulic_diameter(double a, double h) {
  return 4 * flattened_area(a, h) / (2 * std::numbers::pi * a);
}

} // namespace undula::geometry
