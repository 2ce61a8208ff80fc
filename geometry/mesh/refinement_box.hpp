// Boxes in which a mesh is refined.
#pragma once

#include "geometry/mesh/simplex_mesh.hpp"

namespace undula::geometry {

template <int dim>
struct RefinementBox {
  Point<dim> low, high; ///< corners, cm
  double size = 0;      ///< of elements in the box, cm
};

/// Size that a box asks for at x: its own inside, growing by `growth` per unit distance from it. cm.
template <int dim>
double size_about(const RefinementBox<dim>& box, double growth, const Point<dim>& x) {
  return box.size + growth * (x - x.cwiseMax(box.low).cwiseMin(box.high)).norm();
}

} // namespace undula::geometry
