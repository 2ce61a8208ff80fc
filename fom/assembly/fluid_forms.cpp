#include "fom/assembly/forms.hpp"
#include "fom/assembly/part_quadrature.hpp"
#include "fom/space/velocity_element.hpp"

namespace undula::fom {

namespace {
// P1 fields times P1 fields times r, and the smooth hoop term 1/r away from the axis.
constexpr int volume_degree = 4;

/// Adds (force, v) for a force at one point of a part.
template <int dim>
void add_at_point(const Discretisation<dim>& disc, int part, const Eigen::Matrix<double, dim + 1, 1>& lambda,
                  const Point<dim>& force, Eigen::VectorXd& load) {
  with_order(disc, [&](auto order) {
    using Element = VelocityElement<dim, order>;
    const auto shape = Element::values(lambda);
    const auto nodes = Element::nodes_of(disc, part);
    for (int i = 0; i < Element::nodes; ++i)
      for (int c = 0; c < dim; ++c) load[disc.velocity_unknown(nodes[i], c)] += shape[i] * force[c];
  });
}
} // namespace

template <int dim>
PartIntegrals<dim> integrate_part(const Discretisation<dim>& disc, int part,
                                  const PartGeometry<dim>& geometry) {
  static const auto rule = reference_rule<dim>(volume_degree);
  const bool hoop = disc.problem.space == Space::axisymmetric;
  const auto w_domain = domain_velocity(disc, part);
  const bool moves = !w_domain.isZero(0);
  const double widening = moves ? w_domain.cwiseProduct(geometry.gradients).sum() : 0.0;
  PartIntegrals<dim> integrals;
  for_each_point(disc, part, geometry, rule, [&](const auto& lambda, const Point<dim>& x, double w) {
    const Eigen::Matrix<double, dim + 1, dim + 1> product = lambda * lambda.transpose();
    integrals.moments += w * product;
    if (hoop) {
      integrals.over_radius += w / x[0] * product;
      integrals.over_radius_squared += w / (x[0] * x[0]) * product;
      if (moves) integrals.widening += w * w_domain.row(0).dot(lambda) / x[0] * product;
    }
  });
  if (moves) integrals.widening += widening * integrals.moments;
  return integrals;
}

template <int dim>
void add_fluid_mass(const Discretisation<dim>& disc, int part, const PartIntegrals<dim>& integrals,
                    Triplets& out) {
  const auto& nodes = disc.fluid_nodes.part_dofs[part];
  for (int i = 0; i <= dim; ++i)
    for (int j = 0; j <= dim; ++j)
      for (int c = 0; c < dim; ++c)
        out.emplace_back(disc.velocity_unknown(nodes[i], c), disc.velocity_unknown(nodes[j], c),
                         disc.problem.fluid.density * integrals.moments(i, j));
}

template <int dim>
void add_fluid_viscosity_and_pressure(const Discretisation<dim>& disc, int part,
                                      const PartGeometry<dim>& geometry, const PartIntegrals<dim>& integrals,
                                      Triplets& out) {
  const double mu = disc.problem.fluid.viscosity;
  const auto& nodes = disc.fluid_nodes.part_dofs[part];
  const auto& g = geometry.gradients;
  // The barycentric coordinates sum to one: row sums are first moments, the whole is the volume.
  const Eigen::Matrix<double, dim + 1, 1> first = integrals.moments.rowwise().sum();
  const double stress = mu * first.sum();
  for (int i = 0; i <= dim; ++i)
    for (int j = 0; j <= dim; ++j) {
      const double laplace = stress * g.col(i).dot(g.col(j));
      for (int c = 0; c < dim; ++c) {
        const int row = disc.velocity_unknown(nodes[i], c);
        for (int d = 0; d < dim; ++d) {
          double value = stress * g(d, i) * g(c, j);
          if (c == d) value += laplace;
          if (c == 0 && d == 0) value += 2 * mu * integrals.over_radius_squared(i, j);
          out.emplace_back(row, disc.velocity_unknown(nodes[j], d), value);
        }
        double divergence = first[j] * g(c, i);
        if (c == 0) divergence += integrals.over_radius(i, j);
        out.emplace_back(row, disc.pressure_unknown(nodes[j]), -divergence);
        out.emplace_back(disc.pressure_unknown(nodes[j]), row, divergence);
      }
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
    if (!share.has(disc.velocity_unknown(disc.fluid_nodes.part_dofs[piece.part][0], 0))) continue;
    const int cell = disc.cut.parts[piece.part].cell;
    const auto& facet = disc.cut.facets.facets[piece.facet];
    // The barycentric coordinate opposite the facet decreases along the outward normal.
    const Point<dim> normal = -barycentric_gradients(disc.cut.mesh, cell).col(facet.local[0]).normalized();
    for (int q = piece.quadrature_begin; q < piece.quadrature_end; ++q) {
      const auto& x = disc.cut.boundary_quadrature.points[q];
      const double w = disc.cut.boundary_quadrature.weights[q] * measure(x[0]);
      add_at_point<dim>(disc, piece.part, barycentric_coordinates(disc.cut.mesh, cell, x), w * normal, load);
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
      if (!share.has(disc.velocity_unknown(disc.fluid_nodes.part_dofs[p][0], 0))) continue;
      const int part = static_cast<int>(p);
      const auto geometry = part_geometry(disc, part);
      for_each_point(disc, part, geometry, rule, [&](const auto& lambda, const Point<dim>& x, double w) {
        add_at_point<dim>(disc, part, lambda, w * disc.problem.body_force(x, t), load);
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

template struct PartIntegrals<2>;
template PartIntegrals<2> integrate_part(const Discretisation<2>&, int, const PartGeometry<2>&);
template void add_fluid_mass(const Discretisation<2>&, int, const PartIntegrals<2>&, Triplets&);
template void add_fluid_viscosity_and_pressure(const Discretisation<2>&, int, const PartGeometry<2>&,
                                               const PartIntegrals<2>&, Triplets&);
template Eigen::Matrix3d part_convection<2>(double, const Eigen::Matrix3d&,
                                            const Eigen::Matrix<double, 2, 3>&,
                                            const Eigen::Matrix<double, 2, 3>&);
template Eigen::VectorXd opening_functional(const Discretisation<2>&, const Share&, const std::string&);
template Eigen::VectorXd body_force_load(const Discretisation<2>&, const Share&, double);

template struct PartIntegrals<3>;
template PartIntegrals<3> integrate_part(const Discretisation<3>&, int, const PartGeometry<3>&);
template void add_fluid_mass(const Discretisation<3>&, int, const PartIntegrals<3>&, Triplets&);
template void add_fluid_viscosity_and_pressure(const Discretisation<3>&, int, const PartGeometry<3>&,
                                               const PartIntegrals<3>&, Triplets&);
template Eigen::Matrix4d part_convection<3>(double, const Eigen::Matrix4d&,
                                            const Eigen::Matrix<double, 3, 4>&,
                                            const Eigen::Matrix<double, 3, 4>&);
template Eigen::VectorXd opening_functional(const Discretisation<3>&, const Share&, const std::string&);
template Eigen::VectorXd body_force_load(const Discretisation<3>&, const Share&, double);

} // namespace undula::fom
