// What is drawn of a state: the fluid parts of the cut mesh, and the solids at rest with their displacement
// as a field.
#pragma once

#include <array>
#include <span>

#include "fom/output/field_writer.hpp"
#include "fom/time/time_stepper.hpp"

namespace undula::fom {

/// Whether a simplex has so little area (volume) for its longest edge that no gradient can be taken on it.
template <int dim>
bool is_flat(const std::array<Point<dim>, dim + 1>& vertices);

/// Triangles (tetrahedra) of positive orientation that fill the fluid, flat ones left out. Uncut elements
/// share the points of their nodes, and are split through the mid-points of their edges (into four or eight)
/// where the velocity is quadratic; cut parts are filled by simplices with points of their own, so that a
/// field may jump across a membrane thinner than an element.
template <int dim>
struct FluidPicture {
  FieldMesh<dim> mesh;
  std::vector<int> part;                                 ///< by point: one that it belongs to
  std::vector<Eigen::Matrix<double, dim + 1, 1>> lambda; ///< by point: its place there, barycentric
};

template <int dim>
FluidPicture<dim> fluid_picture(const Discretisation<dim>& disc);

/// The same with its points where the map of the domain takes them.
template <int dim>
FluidPicture<dim> moved_picture(const Discretisation<dim>& disc);

/// The quadratic nodes of all solids, one after the other; every element split into four triangles, or eight
/// tetrahedra, through its edge mid-points.
template <int dim>
FieldMesh<dim> solid_picture(const Discretisation<dim>& disc);

/// "velocity" (cm/s) and "pressure" (dyn/cm^2) on the points of the picture.
template <int dim>
std::vector<NodalField> fluid_fields(const Discretisation<dim>& disc, const FluidPicture<dim>& picture,
                                     const State& state);

/// "displacement" (cm) and "velocity" (cm/s) on the points of solid_picture.
template <int dim>
std::vector<NodalField> solid_fields(const Discretisation<dim>& disc, const State& state);

} // namespace undula::fom
