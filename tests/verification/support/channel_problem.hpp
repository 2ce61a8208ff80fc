// A small coupled problem with every kind of condition: a plate clamped to a moving holder across a channel.
#pragma once

#include <numbers>

#include "fom/machines/wave_pump/pump_problem.hpp"
#include "fom/problem/default_weights.hpp"
#include "tests/verification/support/names.hpp"
#include "tests/verification/support/solid_meshes.hpp"

namespace undula::verification {

/// Sizes of the channel, cm. In axisymmetric space x is the radius and x = 0 the axis.
struct ChannelSizes {
  static constexpr double radius = 1.0, height = 0.6;
  static constexpr double plate_inner = 0.3, plate_outer = 0.8, plate_low = 0.283, plate_high = 0.331;
  static constexpr double clamp = 0.7, frequency = 50.0;
  static double holder(double t) { return 0.02 * std::sin(2 * std::numbers::pi * frequency * t); }
};

/// Boundary names "axis" (symmetry), "wall", "outlet" (below, with a head of 500 dyn/cm^2) and "inlet"
/// (above).
inline FsiProblem<2> channel_with_plate(Space space) {
  using Sizes = ChannelSizes;
  using Kind = BoundaryCondition<2>::Kind;
  FsiProblem<2> problem;
  problem.space = space;
  problem.fluid = {1.0, 0.05};
  problem.stabilisation = derived_weights(10.0, 1e-3);
  problem.background = tensor_mesh(spaced(0, Sizes::radius, 12), spaced(0, Sizes::height, 9),
                                   {"axis", "wall", outlet_name, inlet_name});
  problem.boundary["axis"].kind = Kind::symmetry;
  problem.boundary["wall"].kind = Kind::velocity;
  for (const char* name : {outlet_name, inlet_name}) problem.boundary[name].kind = Kind::opening;
  problem.boundary[outlet_name].pressure = [](double) { return 500.0; };
  SolidBody<2> plate;
  plate.name = "plate";
  plate.mesh = box({Sizes::plate_inner, Sizes::plate_low}, {Sizes::plate_outer, Sizes::plate_high}, 10, 2);
  plate.properties = {1.125, 1.686e6, 0.49, 1e-4};
  plate.imposed = [](const Point<2>& x) { return x[0] >= Sizes::clamp; };
  plate.imposed_displacement = [](const Point<2>&, double t) { return Point<2>(0.0, Sizes::holder(t)); };
  problem.solids.push_back(std::move(plate));
  return problem;
}

/// The field `velocity` on fluid and solids, no pressure.
template <class Field>
Eigen::VectorXd interpolate_velocity(const Discretisation<2>& disc, Field&& velocity) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(disc.unknowns());
  const auto positions = unknown_positions(disc);
  for (int i = 0; i < disc.fluid_unknowns(); i += 3) x.segment<2>(i) = velocity(positions[i]);
  for (int i = disc.fluid_unknowns(); i < disc.unknowns(); i += 2) x.segment<2>(i) = velocity(positions[i]);
  return x;
}

} // namespace undula::verification
