// The element of a fluid part where the map of the domain puts it.
//
// The map is linear on every element, so a form on the moved domain is the same form on the moved element:
// its gradients are F^-T grad_X, its volume J dV, its area vectors cof F N dA (Nanson), F = I + grad_X d, J =
// det F. Parts of one element that lie on two sides of a thin solid have nodes of their own and move apart.
// With the identity every number is the one of the background, bit for bit.
#pragma once

#include "fom/space/discretisation.hpp"

namespace undula::fom {

template <int dim>
struct PartGeometry {
  using Corners = Eigen::Matrix<double, dim, dim + 1>;
  Corners corners;             ///< vertices of the moved element, cm
  Corners gradients;           ///< of its barycentric coordinates, 1/cm
  Corners reference_gradients; ///< of the element at rest, 1/cm
  Point<dim> origin;           ///< first vertex of the element at rest, cm
  /// J F^-T: takes area vectors at rest to moved ones.
  Eigen::Matrix<double, dim, dim> cofactor = Eigen::Matrix<double, dim, dim>::Identity();
  double volume_ratio = 1; ///< J, without the hoop's stretch
  double weight = 1;       ///< Discretisation::part_weight

  /// Barycentric coordinates of the material point at `x`, a place at rest.
  Eigen::Matrix<double, dim + 1, 1> barycentric(const Point<dim>& x) const {
    Eigen::Matrix<double, dim + 1, 1> lambda = reference_gradients.transpose() * (x - origin);
    lambda[0] = 1 - lambda.template tail<dim>().sum();
    return lambda;
  }
};

template <int dim>
PartGeometry<dim> part_geometry(const Discretisation<dim>& disc, int part);

/// Geometry of all parts.
template <int dim>
std::vector<PartGeometry<dim>> part_geometries(const Discretisation<dim>& disc);

/// Velocity of the domain at the vertices of a part, cm/s; zero for the identity.
template <int dim>
Eigen::Matrix<double, dim, dim + 1> domain_velocity(const Discretisation<dim>& disc, int part);

/// Smallest ratio of a moved volume to the one at rest over all fluid parts: det F, in axisymmetric space
/// times the stretch of the hoop. 1 for the identity, infinite without fluid; where it is not positive the
/// map has folded.
template <int dim>
struct SmallestVolume {
  double ratio = 1;
  Point<dim> place = Point<dim>::Zero(); ///< centre of that element at rest, cm
};
template <int dim>
SmallestVolume<dim> smallest_volume(const Discretisation<dim>& disc);

/// The ratio alone.
template <int dim>
double smallest_volume_ratio(const Discretisation<dim>& disc) {
  return smallest_volume(disc).ratio;
}

} // namespace undula::fom
