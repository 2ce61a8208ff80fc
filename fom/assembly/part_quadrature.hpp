// Quadrature over one fluid part, with the measure applied.
#pragma once

#include "fom/space/discretisation.hpp"

namespace undula {

/// Calls f(x, weight) over part `part`; uncut parts use `rule` on the whole element.
template <int dim, class F>
void for_each_point(const Discretisation<dim>& disc, int part, const ReferenceRule<dim>& rule, F&& f) {
  const auto& p = disc.cut.parts[part];
  const Measure measure = measure_of(disc.problem.space);
  if (p.cut) {
    for (int q = p.quadrature_begin; q < p.quadrature_end; ++q) {
      const auto& x = disc.cut.volume_quadrature.points[q];
      f(x, disc.cut.volume_quadrature.weights[q] * measure(x[0]));
    }
    return;
  }
  const auto& cell = disc.cut.mesh.cells[p.cell];
  for (std::size_t q = 0; q < rule.weights.size(); ++q) {
    Point<dim> x = Point<dim>::Zero();
    for (int a = 0; a <= dim; ++a) x += rule.barycentric[q][a] * disc.cut.mesh.points[cell[a]];
    f(x, rule.weights[q] * p.measure * measure(x[0]));
  }
}

} // namespace undula
