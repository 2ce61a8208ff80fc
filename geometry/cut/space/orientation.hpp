// On which side of a plane a point lies, decided in floating point where the rounding allows it.
#pragma once

#include "geometry/cut/plane/orientation.hpp"

namespace undula::geometry {

/// Six times the signed volume of the tetrahedron (a, b, c, d), positive if its edges from a are
/// right-handed. The bound is four times that of Shewchuk (1997, stage A of orient3d): (7 + 56 u) u times the
/// permanent, u the unit roundoff; the floor covers underflow.
inline Orientation orientation(const Point<3>& a, const Point<3>& b, const Point<3>& c, const Point<3>& d) {
  constexpr double bound = 4 * 7.771561172376103e-16;
  const double ax = a[0] - d[0], ay = a[1] - d[1], az = a[2] - d[2];
  const double bx = b[0] - d[0], by = b[1] - d[1], bz = b[2] - d[2];
  const double cx = c[0] - d[0], cy = c[1] - d[1], cz = c[2] - d[2];
  const double bxcy = bx * cy, cxby = cx * by, cxay = cx * ay, axcy = ax * cy, axby = ax * by, bxay = bx * ay;
  const double value = az * (cxby - bxcy) + bz * (axcy - cxay) + cz * (bxay - axby);
  const double permanent = std::abs(az) * (std::abs(bxcy) + std::abs(cxby)) +
                           std::abs(bz) * (std::abs(cxay) + std::abs(axcy)) +
                           std::abs(cz) * (std::abs(axby) + std::abs(bxay));
  return {value, bound * permanent + 1e-300};
}

/// The sign in exact arithmetic: 1, -1 or 0.
int exact_orientation(const Point<3>& a, const Point<3>& b, const Point<3>& c, const Point<3>& d);

} // namespace undula::geometry
