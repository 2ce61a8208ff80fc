#include "fom/assembly/forms.hpp"
#include "fom/assembly/part_quadrature.hpp"

namespace undula {

namespace {
// P1 fields times P1 fields times r, and the smooth hoop term 1/r away from the axis.
constexpr int volume_degree = 4;
} // namespace

template <int dim>
PartMoments<dim> part_moments(const Discretisation<dim>& disc, const Share& share) {
  const auto rule = reference_rule<dim>(volume_degree);
  PartMoments<dim> moments(disc.cut.parts.size(), PartMoments<dim>::value_type::Zero());
  for (std::size_t p = 0; p < disc.cut.parts.size(); ++p) {
    const int part = static_cast<int>(p);
    if (!share.has(disc.velocity_unknown(disc.fluid_nodes.part_dofs[part][0], 0))) continue;
    for_each_point(disc, part, rule, [&](const Point<dim>& x, double w) {
      const auto lambda = barycentric_coordinates(disc.cut.mesh, disc.cut.parts[part].cell, x);
      moments[part] += w * lambda * lambda.transpose();
    });
  }
  return moments;
}

template <int dim>
void add_fluid_mass(const Discretisation<dim>& disc, const PartMoments<dim>& moments, Triplets& out) {
  for (std::size_t part = 0; part < moments.size(); ++part) {
    if (moments[part].isZero(0)) continue;
    const auto& nodes = disc.fluid_nodes.part_dofs[part];
    for (int i = 0; i <= dim; ++i)
      for (int j = 0; j <= dim; ++j)
        for (int c = 0; c < dim; ++c)
          out.emplace_back(disc.velocity_unknown(nodes[i], c), disc.velocity_unknown(nodes[j], c),
                           disc.problem.fluid.density * moments[part](i, j));
  }
}

template <int dim>
void add_fluid_viscosity_and_pressure(const Discretisation<dim>& disc, const Share& share, Triplets& out) {
  const auto rule = reference_rule<dim>(volume_degree);
  const double mu = disc.problem.fluid.viscosity;
  const bool hoop = disc.problem.space == Space::axisymmetric;
  constexpr int size = (dim + 1) * (dim + 1);
  for (std::size_t p = 0; p < disc.cut.parts.size(); ++p) {
    const int part = static_cast<int>(p);
    const auto& nodes = disc.fluid_nodes.part_dofs[part];
    if (!share.has(disc.velocity_unknown(nodes[0], 0))) continue;
    const int cell = disc.cut.parts[part].cell;
    const auto g = barycentric_gradients(disc.cut.mesh, cell);
    Eigen::Matrix<double, size, size> local = Eigen::Matrix<double, size, size>::Zero();
    const auto at = [](int node, int component) { return node * (dim + 1) + component; };
    for_each_point(disc, part, rule, [&](const Point<dim>& x, double w) {
      const auto lambda = barycentric_coordinates(disc.cut.mesh, cell, x);
      const double inverse_r = hoop ? 1.0 / x[0] : 0.0;
      const auto divergence = [&](int node, int c) {
        return g(c, node) + (c == 0 ? lambda[node] * inverse_r : 0.0);
      };
      for (int i = 0; i <= dim; ++i)
        for (int j = 0; j <= dim; ++j) {
          const double laplace = g.col(i).dot(g.col(j));
          for (int c = 0; c < dim; ++c) {
            local(at(i, c), at(j, c)) += w * mu * laplace;
            for (int d = 0; d < dim; ++d) local(at(i, d), at(j, c)) += w * mu * g(c, i) * g(d, j);
            local(at(i, c), at(j, dim)) -= w * lambda[j] * divergence(i, c);
            local(at(i, dim), at(j, c)) += w * lambda[i] * divergence(j, c);
          }
          local(at(i, 0), at(j, 0)) += w * 2 * mu * lambda[i] * lambda[j] * inverse_r * inverse_r;
        }
    });
    for (int a = 0; a < size; ++a)
      for (int b = 0; b < size; ++b)
        if (local(a, b) != 0)
          out.emplace_back(nodes[a / (dim + 1)] * (dim + 1) + a % (dim + 1),
                           nodes[b / (dim + 1)] * (dim + 1) + b % (dim + 1), local(a, b));
  }
}

template <int dim>
Eigen::Matrix<double, dim + 1, dim + 1> part_convection(
    double density, const Eigen::Matrix<double, dim + 1, dim + 1>& moments,
    const Eigen::Matrix<double, dim, dim + 1>& gradients, const Eigen::Matrix<double, dim, dim + 1>& b) {
  // (k, j): derivative of shape function j along the convecting velocity of vertex k.
  const Eigen::Matrix<double, dim + 1, dim + 1> transport = b.transpose() * gradients;
  const Eigen::Matrix<double, dim + 1, dim + 1> forward = moments.transpose() * transport;
  return 0.5 * density * (forward - forward.transpose());
}

template <int dim>
Eigen::VectorXd opening_functional(const Discretisation<dim>& disc, const Share& share,
                                   const std::string& name) {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(disc.unknowns());
  const Measure measure = measure_of(disc.problem.space);
  for (const auto& piece : disc.cut.boundary) {
    if (disc.problem.background.boundary_names[piece.tag] != name) continue;
    const auto& nodes = disc.fluid_nodes.part_dofs[piece.part];
    if (!share.has(disc.velocity_unknown(nodes[0], 0))) continue;
    const int cell = disc.cut.parts[piece.part].cell;
    const auto& facet = disc.cut.facets.facets[piece.facet];
    // The barycentric coordinate opposite the facet decreases along the outward normal.
    const Point<dim> normal = -barycentric_gradients(disc.cut.mesh, cell).col(facet.local[0]).normalized();
    for (int q = piece.quadrature_begin; q < piece.quadrature_end; ++q) {
      const auto& x = disc.cut.boundary_quadrature.points[q];
      const double w = disc.cut.boundary_quadrature.weights[q] * measure(x[0]);
      const auto lambda = barycentric_coordinates(disc.cut.mesh, cell, x);
      for (int i = 0; i <= dim; ++i)
        for (int c = 0; c < dim; ++c) load[disc.velocity_unknown(nodes[i], c)] += w * lambda[i] * normal[c];
    }
  }
  return load;
}

template <int dim>
Eigen::VectorXd body_force_load(const Discretisation<dim>& disc, const Share& share, double t) {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(disc.unknowns());
  const auto rule = reference_rule<dim>(volume_degree + 2);
  if (disc.problem.body_force)
    for (std::size_t p = 0; p < disc.cut.parts.size(); ++p) {
      const auto& nodes = disc.fluid_nodes.part_dofs[p];
      if (!share.has(disc.velocity_unknown(nodes[0], 0))) continue;
      for_each_point(disc, static_cast<int>(p), rule, [&](const Point<dim>& x, double w) {
        const auto lambda = barycentric_coordinates(disc.cut.mesh, disc.cut.parts[p].cell, x);
        const Point<dim> force = disc.problem.body_force(x, t);
        for (int i = 0; i <= dim; ++i)
          for (int c = 0; c < dim; ++c) load[disc.velocity_unknown(nodes[i], c)] += w * lambda[i] * force[c];
      });
    }
  const Measure measure = measure_of(disc.problem.space);
  for (std::size_t s = 0; s < disc.problem.solids.size(); ++s) {
    const auto& body = disc.problem.solids[s];
    if (!body.body_force) continue;
    for (std::size_t cell = 0; cell < body.mesh.cells.size(); ++cell) {
      const auto& nodes = disc.solid_spaces[s].cell_nodes[cell];
      if (!share.has(disc.solid_unknown(static_cast<int>(s), nodes[0], 0))) continue;
      const double volume = cell_measure(body.mesh, static_cast<int>(cell));
      for (std::size_t q = 0; q < rule.weights.size(); ++q) {
        Point<dim> x = Point<dim>::Zero();
        for (int a = 0; a <= dim; ++a)
          x += rule.barycentric[q][a] * body.mesh.points[body.mesh.cells[cell][a]];
        const auto shape = quadratic_values<dim>(rule.barycentric[q]);
        const Point<dim> force = rule.weights[q] * volume * measure(x[0]) * body.body_force(x, t);
        for (std::size_t k = 0; k < nodes.size(); ++k)
          for (int c = 0; c < dim; ++c)
            load[disc.solid_unknown(static_cast<int>(s), nodes[k], c)] += shape[k] * force[c];
      }
    }
  }
  return load;
}

template PartMoments<2> part_moments(const Discretisation<2>&, const Share&);
template void add_fluid_mass(const Discretisation<2>&, const PartMoments<2>&, Triplets&);
template void add_fluid_viscosity_and_pressure(const Discretisation<2>&, const Share&, Triplets&);
template Eigen::Matrix3d part_convection<2>(double, const Eigen::Matrix3d&,
                                            const Eigen::Matrix<double, 2, 3>&,
                                            const Eigen::Matrix<double, 2, 3>&);
template Eigen::VectorXd opening_functional(const Discretisation<2>&, const Share&, const std::string&);
template Eigen::VectorXd body_force_load(const Discretisation<2>&, const Share&, double);

} // namespace undula
