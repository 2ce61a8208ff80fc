// The skins of solids as quadratic curves: places, normals, nearest points.
#pragma once

#include <array>
#include <vector>

#include "fom/space/discretisation.hpp"

namespace undula::fom {

/// An edge of a skin with the solid on its left: first, last and middle node.
template <int dim>
struct SkinEdge {
  std::array<int, 3> unknowns;       ///< of component 0, natural order
  std::array<Point<dim>, 3> at_rest; ///< cm
};

/// Skins by solid. Edges on the axis of axisymmetric space are none.
template <int dim>
std::vector<std::vector<SkinEdge<dim>>> skins_of(const Discretisation<dim>& disc);

/// The three nodes of an edge where they are: x(s) = shape(s) . nodes, s in [0, 1].
template <int dim>
using EdgeNodes = std::array<Point<dim>, 3>;

template <int dim>
EdgeNodes<dim> displaced(const SkinEdge<dim>& edge, const Eigen::VectorXd& d);

using EdgeShape = std::array<double, 3>;
EdgeShape edge_shape(double s);
EdgeShape edge_slope(double s);

template <int dim>
Point<dim> on_edge(const EdgeNodes<dim>& nodes, const EdgeShape& shape) {
  return shape[0] * nodes[0] + shape[1] * nodes[1] + shape[2] * nodes[2];
}

/// Out of the solid, of a tangent of its skin; as long as it.
inline Point<2> outward(const Point<2>& tangent) { return {tangent[1], -tangent[0]}; }

/// Place of an edge that is nearest to x: a foot of a perpendicular near [0, 1], else an end.
struct NearestOnEdge {
  double s = 0;
  bool perpendicular = false;
};
template <int dim>
NearestOnEdge nearest_on_edge(const EdgeNodes<dim>& nodes, const Point<dim>& x);

} // namespace undula::fom
