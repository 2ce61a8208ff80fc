// Quadrature over one fluid part, at rest and where the map puts it.
#pragma once

#include "fom/assembly/part_geometry.hpp"

namespace undula::fom {

/// Calls f(lambda, place, weight) over part `part` at rest, without the measure; uncut parts use `rule` on
/// the whole element.
template <int dim, class F>
void for_each_place(const Discretisation<dim>& disc, int part, const PartGeometry<dim>& geometry,
                    const ReferenceRule<dim>& rule, F&& f) {
  const auto& p = disc.cut.parts[part];
  if (p.cut) {
    for (int q = p.quadrature_begin; q < p.quadrature_end; ++q) {
      const auto& place = disc.cut.volume_quadrature.points[q];
      f(geometry.barycentric(place), place, disc.cut.volume_quadrature.weights[q]);
    }
    return;
  }
  const auto& cell = disc.cut.mesh.cells[p.cell];
  for (std::size_t q = 0; q < rule.weights.size(); ++q) {
    Point<dim> place = Point<dim>::Zero();
    for (int a = 0; a <= dim; ++a) place += rule.barycentric[q][a] * disc.cut.mesh.points[cell[a]];
    f(rule.barycentric[q], place, rule.weights[q] * p.measure);
  }
}

/// Calls f(lambda, x, weight) over part `part` where the map puts it: barycentric coordinates, position (cm)
/// and weight with the measure (2 pi r in axisymmetric space) and that of the part.
template <int dim, class F>
void for_each_point(const Discretisation<dim>& disc, int part, const PartGeometry<dim>& geometry,
                    const ReferenceRule<dim>& rule, F&& f) {
  const Measure measure = measure_of(disc.problem.space);
  const bool moved = !disc.map.is_identity();
  for_each_place(disc, part, geometry, rule, [&](const auto& lambda, const Point<dim>& place, double w) {
    const Point<dim> x = moved ? Point<dim>(geometry.corners * lambda) : place;
    f(lambda, x, geometry.weight * w * geometry.volume_ratio * measure(x[0]));
  });
}

} // namespace undula::fom
