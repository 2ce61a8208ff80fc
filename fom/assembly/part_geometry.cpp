#include "fom/assembly/part_geometry.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "fom/assembly/part_quadrature.hpp"

namespace undula::fom {

template <int dim>
PartGeometry<dim> part_geometry(const Discretisation<dim>& disc, int part) {
  PartGeometry<dim> geometry;
  geometry.weight = disc.part_weight(part);
  const int cell = disc.cut.parts[part].cell;
  const auto& points = disc.cut.mesh.cells[cell];
  for (int a = 0; a <= dim; ++a) geometry.corners.col(a) = disc.cut.mesh.points[points[a]];
  geometry.origin = geometry.corners.col(0);
  geometry.reference_gradients = barycentric_gradients(disc.cut.mesh, cell);
  geometry.gradients = geometry.reference_gradients;
  if (disc.map.is_identity()) return geometry;

  typename PartGeometry<dim>::Corners displacement;
  for (int a = 0; a <= dim; ++a)
    displacement.col(a) = disc.map.displacement[disc.fluid_nodes.part_dofs[part][a]];
  const Eigen::Matrix<double, dim, dim> F =
      Eigen::Matrix<double, dim, dim>::Identity() + displacement * geometry.reference_gradients.transpose();
  const Eigen::Matrix<double, dim, dim> inverse_transposed = F.inverse().transpose();
  geometry.corners += displacement;
  geometry.volume_ratio = F.determinant();
  geometry.cofactor = geometry.volume_ratio * inverse_transposed;
  geometry.gradients = inverse_transposed * geometry.reference_gradients;
  return geometry;
}

template <int dim>
std::vector<PartGeometry<dim>> part_geometries(const Discretisation<dim>& disc) {
  std::vector<PartGeometry<dim>> geometries;
  geometries.reserve(disc.cut.parts.size());
  for (std::size_t part = 0; part < disc.cut.parts.size(); ++part)
    geometries.push_back(part_geometry(disc, static_cast<int>(part)));
  return geometries;
}

template <int dim>
Eigen::Matrix<double, dim, dim + 1> domain_velocity(const Discretisation<dim>& disc, int part) {
  Eigen::Matrix<double, dim, dim + 1> velocity = Eigen::Matrix<double, dim, dim + 1>::Zero();
  if (disc.map.velocity.empty()) return velocity;
  for (int a = 0; a <= dim; ++a) velocity.col(a) = disc.map.velocity[disc.fluid_nodes.part_dofs[part][a]];
  return velocity;
}

template <int dim>
SmallestVolume<dim> smallest_volume(const Discretisation<dim>& disc) {
  SmallestVolume<dim> smallest;
  if (disc.map.is_identity() && !disc.cut.parts.empty()) return smallest;
  smallest.ratio = std::numeric_limits<double>::infinity();
  const bool hoop = disc.problem.space == Space::axisymmetric;
  const auto rule = reference_rule<dim>(1);
  for (std::size_t p = 0; p < disc.cut.parts.size(); ++p) {
    const int part = static_cast<int>(p);
    const auto geometry = part_geometry(disc, part);
    double hoop_stretch = 1;
    if (hoop) {
      hoop_stretch = std::numeric_limits<double>::infinity();
      for_each_place(disc, part, geometry, rule, [&](const auto&, const Point<dim>& place, double) {
        const double moved = (geometry.corners * geometry.barycentric(place))[0];
        hoop_stretch = std::min(hoop_stretch, moved / place[0]);
      });
    }
    // Both factors negative would be a folded element too.
    const double ratio = geometry.volume_ratio > 0 ? geometry.volume_ratio * hoop_stretch
                                                   : std::min(geometry.volume_ratio, hoop_stretch);
    if (ratio >= smallest.ratio) continue;
    smallest.ratio = ratio;
    smallest.place.setZero();
    for (const int point : disc.cut.mesh.cells[disc.cut.parts[p].cell])
      smallest.place += disc.cut.mesh.points[point] / (dim + 1);
  }
  return smallest;
}

template PartGeometry<2> part_geometry(const Discretisation<2>&, int);
template std::vector<PartGeometry<2>> part_geometries(const Discretisation<2>&);
template Eigen::Matrix<double, 2, 3> domain_velocity(const Discretisation<2>&, int);
template SmallestVolume<2> smallest_volume(const Discretisation<2>&);

template PartGeometry<3> part_geometry(const Discretisation<3>&, int);
template std::vector<PartGeometry<3>> part_geometries(const Discretisation<3>&);
template Eigen::Matrix<double, 3, 4> domain_velocity(const Discretisation<3>&, int);
template SmallestVolume<3> smallest_volume(const Discretisation<3>&);

} // namespace undula::fom
