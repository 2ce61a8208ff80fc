#include "fom/assembly/forms.hpp"
#include "fom/materials/solid_laws.hpp"

namespace undula::fom {

namespace {

// P2 times P2 times r.
constexpr int solid_degree = 5;

/// Calls f(solid, cell) for the cells of the share in solids with factor(solid) not 0.
template <int dim, class F>
void for_each_solid_cell(const Discretisation<dim>& disc, const Share& share, const SolidFactor<dim>& factor,
                         F&& f) {
  for (std::size_t s = 0; s < disc.problem.solids.size(); ++s) {
    const auto& body = disc.problem.solids[s];
    if (factor(body) == 0) continue;
    const int solid = static_cast<int>(s);
    for (std::size_t c = 0; c < body.mesh.cells.size(); ++c)
      if (share.has(disc.solid_unknown(solid, disc.solid_spaces[s].cell_nodes[c][0], 0)))
        f(solid, static_cast<int>(c));
  }
}

/// Calls f(lambda, x, weight) over the quadrature points of a cell.
template <int dim, class F>
void for_each_solid_point(const Discretisation<dim>& disc, int solid, int cell, F&& f) {
  static const auto rule = reference_rule<dim>(solid_degree);
  const Measure measure = measure_of(disc.problem.space);
  const auto& mesh = disc.problem.solids[solid].mesh;
  const double volume = cell_measure(mesh, cell);
  for (std::size_t q = 0; q < rule.weights.size(); ++q) {
    Point<dim> x = Point<dim>::Zero();
    for (int a = 0; a <= dim; ++a) x += rule.barycentric[q][a] * mesh.points[mesh.cells[cell][a]];
    f(rule.barycentric[q], x, rule.weights[q] * volume * measure(x[0]));
  }
}

} // namespace

template <int dim>
void add_solid_mass(const Discretisation<dim>& disc, const Share& share, const SolidFactor<dim>& factor,
                    Triplets& out) {
  constexpr int count = QuadraticSpace<dim>::nodes_per_cell;
  for_each_solid_cell(disc, share, factor, [&](int solid, int cell) {
    const auto& body = disc.problem.solids[solid];
    const double density = factor(body) * body.properties.density;
    Eigen::Matrix<double, count, count> local = Eigen::Matrix<double, count, count>::Zero();
    for_each_solid_point(disc, solid, cell, [&](const auto& lambda, const Point<dim>&, double w) {
      const auto shape = quadratic_values<dim>(lambda);
      local.noalias() += (w * density * shape) * shape.transpose();
    });
    const auto& nodes = disc.solid_spaces[solid].cell_nodes[cell];
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < count; ++j)
        for (int c = 0; c < dim; ++c)
          out.emplace_back(disc.solid_unknown(solid, nodes[i], c), disc.solid_unknown(solid, nodes[j], c),
                           local(i, j));
  });
}

template <int dim>
void add_solid_stiffness(const Discretisation<dim>& disc, const Share& share, const SolidFactor<dim>& factor,
                         Triplets& out) {
  constexpr int count = QuadraticSpace<dim>::nodes_per_cell;
  const bool hoop = disc.problem.space == Space::axisymmetric;
  for_each_solid_cell(disc, share, factor, [&](int solid, int cell) {
    const auto& body = disc.problem.solids[solid];
    const auto lame = lame_constants(body.properties);
    const double times = factor(body);
    const auto cell_gradients = barycentric_gradients(body.mesh, cell);
    // (i, d), (j, c): test component d of node i, trial component c of node j.
    Eigen::Matrix<double, dim * count, dim* count> local =
        Eigen::Matrix<double, dim * count, dim * count>::Zero();
    for_each_solid_point(disc, solid, cell, [&](const auto& lambda, const Point<dim>& x, double w) {
      const double first = times * w * lame.lambda, shear = times * w * lame.mu;
      const auto shape = quadratic_values<dim>(lambda);
      const auto g = quadratic_gradients<dim>(lambda, cell_gradients);
      const double inverse_r = hoop ? 1.0 / x[0] : 0.0;
      Eigen::Matrix<double, dim * count, 1> divergence;
      for (int k = 0; k < count; ++k)
        for (int c = 0; c < dim; ++c)
          divergence[k * dim + c] = g(c, k) + (c == 0 ? shape[k] * inverse_r : 0.0);
      local.noalias() += (first * divergence) * divergence.transpose();
      for (int i = 0; i < count; ++i)
        for (int j = 0; j < count; ++j) {
          const double laplace = shear * g.col(i).dot(g.col(j));
          for (int d = 0; d < dim; ++d) {
            for (int c = 0; c < dim; ++c) local(i * dim + d, j * dim + c) += shear * g(c, i) * g(d, j);
            local(i * dim + d, j * dim + d) += laplace;
          }
          local(i * dim, j * dim) += 2 * shear * shape[i] * shape[j] * inverse_r * inverse_r;
        }
    });
    const auto& nodes = disc.solid_spaces[solid].cell_nodes[cell];
    for (int a = 0; a < dim * count; ++a)
      for (int b = 0; b < dim * count; ++b)
        out.emplace_back(disc.solid_unknown(solid, nodes[a / dim], a % dim),
                         disc.solid_unknown(solid, nodes[b / dim], b % dim), local(a, b));
  });
}

template void add_solid_mass(const Discretisation<2>&, const Share&, const SolidFactor<2>&, Triplets&);
template void add_solid_stiffness(const Discretisation<2>&, const Share&, const SolidFactor<2>&, Triplets&);

template void add_solid_mass(const Discretisation<3>&, const Share&, const SolidFactor<3>&, Triplets&);
template void add_solid_stiffness(const Discretisation<3>&, const Share&, const SolidFactor<3>&, Triplets&);

} // namespace undula::fom
