// On which side of a line a point lies, decided in floating point where the rounding allows it.
#pragma once

#include <cmath>

#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::geometry {

/// Twice the signed area of a triangle (cm^2) with a bound of its rounding error.
struct Orientation {
  double value = 0;
  double error = 0;
  /// 1 or -1 where certain, else 0.
  int sign() const { return value > error ? 1 : value < -error ? -1 : 0; }
};

/// Orientation of (a, b, c), positive if c lies left of a -> b. The bound is four times that of Shewchuk
/// (1997, stage A of orient2d): (3 + 16 u) u (|left| + |right|), u the unit roundoff; the floor covers
/// underflow.
inline Orientation orientation(const Point<2>& a, const Point<2>& b, const Point<2>& c) {
  constexpr double bound = 4 * 3.3306690738754716e-16;
  const double left = (a[0] - c[0]) * (b[1] - c[1]);
  const double right = (a[1] - c[1]) * (b[0] - c[0]);
  return {left - right, bound * (std::abs(left) + std::abs(right)) + 1e-300};
}

/// The sign in exact arithmetic: 1, -1 or 0.
int exact_orientation(const Point<2>& a, const Point<2>& b, const Point<2>& c);

} // namespace undula::geometry
