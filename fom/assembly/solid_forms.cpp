#include "fom/assembly/forms.hpp"

namespace undula {

namespace {

// P2 times P2 times r.
constexpr int solid_degree = 5;

/// Calls f(solid, cell, nodes, lambda, x, weight) over the quadrature points of all solids in the share.
template <int dim, class F>
void for_each_solid_point(const Discretisation<dim>& disc, const Share& share, F&& f) {
  const auto rule = reference_rule<dim>(solid_degree);
  const Measure measure = measure_of(disc.problem.space);
  for (std::size_t s = 0; s < disc.problem.solids.size(); ++s) {
    const auto& mesh = disc.problem.solids[s].mesh;
    const int solid = static_cast<int>(s);
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
      const auto& nodes = disc.solid_spaces[s].cell_nodes[c];
      if (!share.has(disc.solid_unknown(solid, nodes[0], 0))) continue;
      const double volume = cell_measure(mesh, static_cast<int>(c));
      for (std::size_t q = 0; q < rule.weights.size(); ++q) {
        Point<dim> x = Point<dim>::Zero();
        for (int a = 0; a <= dim; ++a) x += rule.barycentric[q][a] * mesh.points[mesh.cells[c][a]];
        f(solid, static_cast<int>(c), nodes, rule.barycentric[q], x,
          rule.weights[q] * volume * measure(x[0]));
      }
    }
  }
}

} // namespace

template <int dim>
void add_solid_mass(const Discretisation<dim>& disc, const Share& share, const SolidFactor<dim>& factor,
                    Triplets& out) {
  for_each_solid_point(
      disc, share, [&](int solid, int, const auto& nodes, const auto& lambda, const Point<dim>&, double w) {
        const auto& body = disc.problem.solids[solid];
        const double times = factor(body);
        if (times == 0) return;
        const auto shape = quadratic_values<dim>(lambda);
        const double density = times * body.properties.density;
        for (std::size_t i = 0; i < nodes.size(); ++i)
          for (std::size_t j = 0; j < nodes.size(); ++j)
            for (int c = 0; c < dim; ++c)
              out.emplace_back(disc.solid_unknown(solid, nodes[i], c), disc.solid_unknown(solid, nodes[j], c),
                               w * density * shape[i] * shape[j]);
      });
}

template <int dim>
void add_solid_stiffness(const Discretisation<dim>& disc, const Share& share, const SolidFactor<dim>& factor,
                         Triplets& out) {
  const bool hoop = disc.problem.space == Space::axisymmetric;
  for_each_solid_point(
      disc, share,
      [&](int solid, int cell, const auto& nodes, const auto& lambda, const Point<dim>& x, double w) {
        const auto& body = disc.problem.solids[solid];
        const double young = body.properties.young, poisson = body.properties.poisson;
        const double scale = w * factor(body);
        const double lame = scale * young * poisson / ((1 + poisson) * (1 - 2 * poisson));
        const double shear = scale * young / (2 * (1 + poisson));
        const auto shape = quadratic_values<dim>(lambda);
        const auto g = quadratic_gradients<dim>(lambda, barycentric_gradients(body.mesh, cell));
        const double inverse_r = hoop ? 1.0 / x[0] : 0.0;
        const auto divergence = [&](std::size_t k, int c) {
          return g(c, k) + (c == 0 ? shape[k] * inverse_r : 0.0);
        };
        for (std::size_t i = 0; i < nodes.size(); ++i)
          for (std::size_t j = 0; j < nodes.size(); ++j)
            for (int d = 0; d < dim; ++d)
              for (int c = 0; c < dim; ++c) {
                double value = lame * divergence(i, d) * divergence(j, c) + shear * g(c, i) * g(d, j);
                if (c == d) value += shear * g.col(i).dot(g.col(j));
                if (c == 0 && d == 0) value += 2 * shear * shape[i] * shape[j] * inverse_r * inverse_r;
                out.emplace_back(disc.solid_unknown(solid, nodes[i], d),
                                 disc.solid_unknown(solid, nodes[j], c), value);
              }
      });
}

template void add_solid_mass(const Discretisation<2>&, const Share&, const SolidFactor<2>&, Triplets&);
template void add_solid_stiffness(const Discretisation<2>&, const Share&, const SolidFactor<2>&, Triplets&);

} // namespace undula
