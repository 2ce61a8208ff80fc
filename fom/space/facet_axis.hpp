// The coordinate axis that a flat side of the domain is perpendicular to.
#pragma once

#include "fom/fom.hpp"
#include "geometry/cut/cut_mesh.hpp"

namespace undula::fom {

/// Axis along which facet `facet` of the background is thinnest: its normal, where it lies in a coordinate
/// plane.
template <int dim>
int normal_axis(const CutMesh<dim>& cut, int facet) {
  Point<dim> low = cut.mesh.points[cut.facets.facets[facet].points[0]], high = low;
  for (const int p : cut.facets.facets[facet].points) {
    low = low.cwiseMin(cut.mesh.points[p]);
    high = high.cwiseMax(cut.mesh.points[p]);
  }
  int axis = 0;
  (high - low).minCoeff(&axis);
  return axis;
}

} // namespace undula::fom
