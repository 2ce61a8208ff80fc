// Manufactured flows: a stream function and a pressure, everything else by exact differentiation.
#pragma once

#include <functional>

#include "fom/problem/problem.hpp"
#include "tests/verification/support/names.hpp"
#include "tests/verification/support/taylor.hpp"

namespace undula::verification {

using Jet = Taylor<3>;

/// A solenoidal steady field. Plane: u = (dpsi/dy, -dpsi/dx). Axisymmetric, with the stream function r^2 chi:
/// u = (-r dchi/dz, 2 chi + r dchi/dr), smooth on the axis when chi is even in r.
struct ManufacturedFlow {
  Space space = Space::plane;
  double density = 1, viscosity = 1;
  bool convects = false;
  std::function<Jet(const Jet&, const Jet&)> stream; ///< psi or chi
  std::function<Jet(const Jet&, const Jet&)> pressure;
};

/// Values of a flow at one point. gradient(i, j) = d u_i / d x_j.
struct FlowSample {
  Point<2> velocity;
  Eigen::Matrix2d gradient;
  double pressure;
  Point<2> force; ///< density (u.grad) u - div sigma, dyn/cm^3
};

inline FlowSample sample(const ManufacturedFlow& flow, const Point<2>& point) {
  const Jet x = coordinate<3>(0, point[0]), y = coordinate<3>(1, point[1]);
  const Jet s = flow.stream(x, y), p = flow.pressure(x, y);
  const bool ring = flow.space == Space::axisymmetric;
  const Jet u[2] = {ring ? -x * s.differentiated(1) : s.differentiated(1),
                    ring ? 2 * s + x * s.differentiated(0) : -s.differentiated(0)};
  FlowSample at;
  at.velocity = {u[0].value(), u[1].value()};
  at.pressure = p.value();
  for (int i = 0; i < 2; ++i) at.gradient.row(i) << u[i].derivative(1, 0), u[i].derivative(0, 1);
  for (int i = 0; i < 2; ++i) {
    double laplace = u[i].derivative(2, 0) + u[i].derivative(0, 2);
    if (ring) {
      const double r = point[0];
      laplace += at.gradient(i, 0) / r;
      if (i == 0) laplace -= at.velocity[0] / (r * r);
    }
    at.force[i] = p.derivative(i == 0, i == 1) - flow.viscosity * laplace;
    if (flow.convects) at.force[i] += flow.density * at.gradient.row(i).dot(at.velocity);
  }
  return at;
}

/// Velocity alone; unlike `sample` it may be taken on the axis.
inline Point<2> velocity_at(const ManufacturedFlow& flow, const Point<2>& point) {
  const Jet s = flow.stream(coordinate<3>(0, point[0]), coordinate<3>(1, point[1]));
  if (flow.space == Space::plane) return {s.derivative(0, 1), -s.derivative(1, 0)};
  return {-point[0] * s.derivative(0, 1), 2 * s.value() + point[0] * s.derivative(1, 0)};
}

} // namespace undula::verification
