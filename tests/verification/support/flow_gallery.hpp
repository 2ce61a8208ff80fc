// The manufactured flows of the tests. Those around a solid vanish on its skin to second order (psi ~
// distance^2), and none passes through the sides of the unit square.
#pragma once

#include <cmath>
#include <numbers>

#include "tests/verification/support/manufactured.hpp"

namespace undula::verification {

inline Jet square(const Jet& f) { return f * f; }

inline Jet smooth_pressure(const Jet& x, const Jet& y) {
  return sin(Jet(2.5) * x + Jet(0.3)) * cos(Jet(2) * y) + Jet(0.4) * y;
}

/// A rectangle in axes turned by `angle`: |X| <= half_x, |Y| <= half_y about the centre.
struct TurnedBox {
  Point<2> centre;
  double half_x = 0, half_y = 0, angle = 0;
};

/// One vortex in the square, no solid.
inline ManufacturedFlow plane_vortex() {
  ManufacturedFlow flow;
  flow.stream = [](const Jet& x, const Jet& y) {
    const Jet pi(std::numbers::pi);
    return sin(pi * x) * sin(pi * y) * (Jet(1) + x * y) * Jet(0.4);
  };
  flow.pressure = smooth_pressure;
  return flow;
}

/// A vortex around the box: psi = (product of the four lines of the box)^2 sin(pi x) sin(pi y).
inline ManufacturedFlow plane_flow_around(const TurnedBox& box) {
  ManufacturedFlow flow;
  flow.stream = [box](const Jet& x, const Jet& y) {
    const double c = std::cos(box.angle), s = std::sin(box.angle);
    const Jet dx = x - Jet(box.centre[0]), dy = y - Jet(box.centre[1]);
    const Jet along = Jet(c) * dx + Jet(s) * dy, across = Jet(c) * dy - Jet(s) * dx;
    const Jet lines =
        (square(along) - Jet(box.half_x * box.half_x)) * (square(across) - Jet(box.half_y * box.half_y));
    const Jet pi(std::numbers::pi);
    return Jet(200) * square(lines) * sin(pi * x) * sin(pi * y);
  };
  flow.pressure = smooth_pressure;
  return flow;
}

/// A vortex ring with flow along the axis, no solid.
inline ManufacturedFlow axisymmetric_vortex() {
  ManufacturedFlow flow;
  flow.space = Space::axisymmetric;
  flow.stream = [](const Jet& r, const Jet& z) {
    return (Jet(1) - square(r)) * sin(Jet(std::numbers::pi) * z) * (Jet(1) + Jet(0.5) * z);
  };
  flow.pressure = [](const Jet& r, const Jet& z) {
    return cos(Jet(2) * square(r)) * sin(Jet(2) * z + Jet(0.3));
  };
  return flow;
}

/// The same around a ring of rectangular section, given in the meridian plane (angle 0).
inline ManufacturedFlow axisymmetric_flow_around(const TurnedBox& box) {
  auto flow = axisymmetric_vortex();
  flow.stream = [box](const Jet& r, const Jet& z) {
    const double inner = box.centre[0] - box.half_x, outer = box.centre[0] + box.half_x;
    const Jet lines = (square(r) - Jet(inner * inner)) * (square(r) - Jet(outer * outer)) *
                      (square(z - Jet(box.centre[1])) - Jet(box.half_y * box.half_y));
    return Jet(400) * square(lines) * (Jet(1) - square(r)) * sin(Jet(std::numbers::pi) * z);
  };
  return flow;
}

} // namespace undula::verification
