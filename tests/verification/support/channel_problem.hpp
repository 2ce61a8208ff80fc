// A small coupled problem with every kind of condition: a plate clamped to a moving holder across a channel.
#pragma once

#include <numbers>
#include <string>

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

/// What the forms are tested on.
struct Elements {
  Space space = Space::plane;
  int velocity_order = 1;
  std::string name() const {
    return (space == Space::axisymmetric ? "Axisymmetric" : "Plane") + std::to_string(velocity_order);
  }
};
constexpr Elements all_elements[] = {
    {Space::plane, 1}, {Space::axisymmetric, 1}, {Space::plane, 2}, {Space::axisymmetric, 2}};

/// Boundary names "axis" (symmetry), "wall", "outlet" (below, with a head of 500 dyn/cm^2) and "inlet"
/// (above).
inline FsiProblem<2> channel_with_plate(Space space, int velocity_order = 1) {
  using Sizes = ChannelSizes;
  using Kind = BoundaryCondition<2>::Kind;
  FsiProblem<2> problem;
  problem.space = space;
  problem.velocity_order = velocity_order;
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

inline FsiProblem<2> channel_with_plate(const Elements& elements) {
  return channel_with_plate(elements.space, elements.velocity_order);
}

/// The field `velocity` on fluid and solids, no pressure.
template <class Field>
Eigen::VectorXd interpolate_velocity(const Discretisation<2>& disc, Field&& velocity) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(disc.unknowns());
  const auto positions = unknown_positions(disc);
  for (int node = 0; node < disc.velocity_nodes(); ++node)
    x.segment<2>(disc.velocity_unknown(node, 0)) = velocity(disc.velocity_position(node));
  for (int i = disc.fluid_unknowns(); i < disc.unknowns(); i += 2) x.segment<2>(i) = velocity(positions[i]);
  return x;
}

} // namespace undula::verification
