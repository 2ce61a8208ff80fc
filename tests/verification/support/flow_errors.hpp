// Errors of a discrete flow against a manufactured one over the fluid, uncut and cut parts alike.
#pragma once

#include <cmath>

#include "fom/assembly/part_quadrature.hpp"
#include "fom/space/velocity_element.hpp"
#include "tests/verification/support/manufactured.hpp"
#include "tests/verification/support/names.hpp"

namespace undula::verification {

/// Relative errors: divided by the norm of the exact field. Pressures are compared up to a constant.
struct FlowErrors {
  double velocity_l2 = 0;
  double velocity_h1 = 0; ///< seminorm
  double pressure_l2 = 0;
};

/// Velocity, its gradient and pressure at a point are exact(point).velocity, .gradient and .pressure.
template <int dim, class Exact>
FlowErrors flow_errors_of(const Discretisation<dim>& disc, const Eigen::VectorXd& x, Exact&& exact_at) {
  const auto rule = reference_rule<dim>(6);
  double volume = 0, mean_error = 0, mean_exact = 0;
  double velocity = 0, gradient = 0, pressure = 0, velocity_norm = 0, gradient_norm = 0, pressure_norm = 0;
  for (int part = 0; part < static_cast<int>(disc.cut.parts.size()); ++part) {
    const auto geometry = part_geometry(disc, part);
    for_each_point(disc, part, geometry, rule, [&](const auto& lambda, const Point<dim>& point, double w) {
      const auto exact = exact_at(point);
      const auto [field, discrete_gradient] = sample_velocity<dim>(disc, part, geometry.gradients, lambda, x);
      const double difference = sample_pressure<dim>(disc, part, lambda, x) - exact.pressure;
      volume += w;
      mean_error += w * difference;
      mean_exact += w * exact.pressure;
      velocity += w * (field - exact.velocity).squaredNorm();
      velocity_norm += w * exact.velocity.squaredNorm();
      gradient += w * (discrete_gradient - exact.gradient).squaredNorm();
      gradient_norm += w * exact.gradient.squaredNorm();
      pressure += w * difference * difference;
      pressure_norm += w * exact.pressure * exact.pressure;
    });
  }
  pressure -= mean_error * mean_error / volume;
  pressure_norm -= mean_exact * mean_exact / volume;
  return {std::sqrt(velocity / velocity_norm), std::sqrt(gradient / gradient_norm),
          std::sqrt(pressure / pressure_norm)};
}

inline FlowErrors flow_errors(const Discretisation<2>& disc, const Eigen::VectorXd& x,
                              const ManufacturedFlow& flow) {
  return flow_errors_of(disc, x, [&](const Point<2>& point) { return sample(flow, point); });
}

} // namespace undula::verification
