// Structured meshes and conditions for tests of solids and of their interaction with the fluid.
#pragma once

#include <functional>
#include <stdexcept>

#include "fom/space/discretisation.hpp"
#include "tests/verification/support/names.hpp"
#include "tests/verification/support/rectangle_mesh.hpp"

namespace undula::verification {

/// The box [low, high] of nx x ny quadrilaterals, each split in two.
inline SimplexMesh<2> box(const Point<2>& low, const Point<2>& high, int nx, int ny) {
  return tensor_mesh(spaced(low[0], high[0], nx), spaced(low[1], high[1], ny));
}

/// A solid alone, without fluid. Stokes, so that nothing is left to iterate.
inline FsiProblem<2> in_vacuo(Space space, SolidBody<2> body) {
  FsiProblem<2> problem;
  problem.space = space;
  problem.flow = FlowModel::stokes;
  problem.fluid = {1.0, 1.0};
  problem.solids.push_back(std::move(body));
  return problem;
}

/// Holds component `component` of the solid's nodes where `where` holds: sliding supports and the axis.
inline void hold_component(Discretisation<2>& disc, int solid, int component,
                           const std::function<bool(const Point<2>&)>& where) {
  const auto& nodes = disc.solid_spaces[solid].nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const int unknown = disc.solid_unknown(solid, static_cast<int>(i), component);
    if (!where(nodes[i]) || disc.is_constrained[unknown]) continue;
    disc.constrained.push_back({unknown, component, nodes[i], nullptr});
    disc.is_constrained[unknown] = 1;
  }
}

/// The solid's node at x (to 1e-9 of its distance from the origin, or 1e-12 cm).
inline int node_at(const Discretisation<2>& disc, int solid, const Point<2>& x) {
  const auto& nodes = disc.solid_spaces[solid].nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if ((nodes[i] - x).norm() <= 1e-12 + 1e-9 * x.norm()) return static_cast<int>(i);
  throw std::runtime_error("no node of the solid at the place asked for");
}

} // namespace undula::verification
