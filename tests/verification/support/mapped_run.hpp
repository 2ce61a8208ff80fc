// Marches a problem on a domain that moves by a prescribed map: one cut, operators built anew at every step.
#pragma once

#include <functional>

#include "fom/mapping/domain_extension.hpp"
#include "fom/time/time_stepper.hpp"
#include "tests/verification/support/names.hpp"

namespace undula::verification {

/// Displacement of the fluid's nodes at time t, cm.
using MapOfTime = std::function<std::vector<Point<2>>(const Discretisation<2>&, double)>;

/// `field`(X, t) on every fluid node.
inline MapOfTime nodal_map(VectorField<2> field) {
  return [field](const Discretisation<2>& disc, double t) {
    std::vector<Point<2>> displacement;
    for (const int point : disc.fluid_nodes.dof_point)
      displacement.push_back(field(disc.cut.mesh.points[point], t));
    return displacement;
  };
}

/// The extension of the displacement imposed on solids that are imposed as a whole.
inline MapOfTime extended_map(const DomainExtension<2>& extension) {
  return [&extension](const Discretisation<2>& disc, double t) {
    Eigen::VectorXd d = Eigen::VectorXd::Zero(disc.solid_unknowns());
    for (const auto& node : disc.imposed)
      d.segment<2>(node.unknown - disc.fluid_unknowns()) = imposed_displacement(disc, node, t);
    return extend(extension, d);
  };
}

/// Map at time t and its rate by the scheme, from the map at the two times before.
inline void set_map(Discretisation<2>& disc, const MapOfTime& map, TimeScheme scheme, int step, double dt) {
  const auto alpha = bdf_coefficients(scheme, step);
  const double t = step * dt;
  disc.map.displacement = map(disc, t);
  const auto before = map(disc, t - dt), older = map(disc, std::max(t - 2 * dt, 0.0));
  disc.map.velocity.resize(before.size());
  for (std::size_t i = 0; i < before.size(); ++i)
    disc.map.velocity[i] =
        (alpha[0] * disc.map.displacement[i] + alpha[1] * before[i] + alpha[2] * older[i]) / dt;
}

/// Steps to `steps` * dt; `after`(state, operators) sees every step.
inline State march_mapped(Discretisation<2>& disc, const MapOfTime& map, TimeScheme scheme, double dt,
                          int steps, State state,
                          const std::function<void(const State&, const Operators<2>&)>& after = nullptr) {
  PhaseTimer timer;
  while (state.step < steps) {
    set_map(disc, map, scheme, state.step + 1, dt);
    const auto operators = build_operators(disc, MPI_COMM_SELF, timer);
    TimeStepper<2> stepper(disc, operators, scheme, dt, 1, timer);
    stepper.advance(state);
    if (after) after(state, operators);
  }
  return state;
}

} // namespace undula::verification
