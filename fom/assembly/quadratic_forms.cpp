#include "fom/assembly/quadratic_forms.hpp"

#include "fom/assembly/part_quadrature.hpp"

namespace undula::fom {

namespace {
// Products of two quadratic fields times r, and the smooth hoop term 1/r away from the axis.
constexpr int volume_degree = 5;
// Three quadratic fields, one of them differentiated, times r.
constexpr int convection_degree = 6;
} // namespace

template <int dim>
void add_quadratic_part(const Discretisation<dim>& disc, int part, const PartGeometry<dim>& geometry,
                        Triplets& mass, Triplets& physical) {
  using Element = VelocityElement<dim, 2>;
  constexpr int nodes = Element::nodes;
  static const auto rule = reference_rule<dim>(volume_degree);
  const double mu = disc.problem.fluid.viscosity;
  const bool hoop = disc.problem.space == Space::axisymmetric;
  QuadraticProducts<dim> products = QuadraticProducts<dim>::Zero();
  Eigen::Matrix<double, dim * nodes, dim* nodes> viscous =
      Eigen::Matrix<double, dim * nodes, dim * nodes>::Zero();
  Eigen::Matrix<double, dim * nodes, dim + 1> divergence =
      Eigen::Matrix<double, dim * nodes, dim + 1>::Zero();
  for_each_point(disc, part, geometry, rule, [&](const auto& lambda, const Point<dim>& x, double w) {
    const auto shape = Element::values(lambda);
    const auto g = Element::gradients(lambda, geometry.gradients);
    products.noalias() += (w * shape) * shape.transpose();
    const QuadraticProducts<dim> laplace = (w * mu) * (g.transpose() * g);
    Eigen::Matrix<double, dim * nodes, 1> widening;
    for (int i = 0; i < nodes; ++i)
      for (int c = 0; c < dim; ++c)
        widening[i * dim + c] = g(c, i) + (hoop && c == 0 ? shape[i] / x[0] : 0.0);
    divergence.noalias() += (w * widening) * lambda.transpose();
    for (int i = 0; i < nodes; ++i)
      for (int j = 0; j < nodes; ++j)
        for (int c = 0; c < dim; ++c) {
          for (int d = 0; d < dim; ++d) viscous(i * dim + c, j * dim + d) += w * mu * g(d, i) * g(c, j);
          viscous(i * dim + c, j * dim + c) += laplace(i, j);
        }
    if (hoop) {
      const double stretch = 2 * mu * w / (x[0] * x[0]);
      for (int i = 0; i < nodes; ++i)
        for (int j = 0; j < nodes; ++j) viscous(i * dim, j * dim) += stretch * shape[i] * shape[j];
    }
  });
  const auto at = Element::nodes_of(disc, part);
  for (int i = 0; i < nodes; ++i)
    for (int c = 0; c < dim; ++c) {
      const int row = disc.velocity_unknown(at[i], c);
      for (int j = 0; j < nodes; ++j) {
        mass.emplace_back(row, disc.velocity_unknown(at[j], c), disc.problem.fluid.density * products(i, j));
        for (int d = 0; d < dim; ++d)
          physical.emplace_back(row, disc.velocity_unknown(at[j], d), viscous(i * dim + c, j * dim + d));
      }
      for (int a = 0; a <= dim; ++a) {
        const int column = disc.pressure_unknown(at[a]);
        physical.emplace_back(row, column, -divergence(i * dim + c, a));
        physical.emplace_back(column, row, divergence(i * dim + c, a));
      }
    }
}

template <int dim>
QuadraticProducts<dim> quadratic_convection(const Discretisation<dim>& disc, int part,
                                            const PartGeometry<dim>& geometry,
                                            const typename VelocityElement<dim, 2>::Coefficients& b) {
  using Element = VelocityElement<dim, 2>;
  static const auto rule = reference_rule<dim>(convection_degree);
  const double density = disc.problem.fluid.density;
  const bool hoop = disc.problem.space == Space::axisymmetric, moves = !disc.map.velocity.empty();
  const auto domain = domain_velocity(disc, part);
  const double widening = moves ? domain.cwiseProduct(geometry.gradients).sum() : 0.0;
  QuadraticProducts<dim> forward = QuadraticProducts<dim>::Zero(), widened = QuadraticProducts<dim>::Zero();
  for_each_point(disc, part, geometry, rule, [&](const auto& lambda, const Point<dim>& x, double w) {
    const auto shape = Element::values(lambda);
    Point<dim> relative = b * shape;
    if (moves) relative -= domain * lambda;
    const typename Element::Values transport =
        Element::gradients(lambda, geometry.gradients).transpose() * relative;
    forward.noalias() += (w * shape) * transport.transpose();
    if (moves) {
      const double rate = widening + (hoop ? (domain.row(0).dot(lambda)) / x[0] : 0.0);
      widened.noalias() += (w * rate * shape) * shape.transpose();
    }
  });
  QuadraticProducts<dim> convection = 0.5 * density * (forward - forward.transpose());
  if (moves) convection += 0.5 * density * widened;
  return convection;
}

template void add_quadratic_part(const Discretisation<2>&, int, const PartGeometry<2>&, Triplets&, Triplets&);
template QuadraticProducts<2> quadratic_convection(const Discretisation<2>&, int, const PartGeometry<2>&,
                                                   const VelocityElement<2, 2>::Coefficients&);

template void add_quadratic_part(const Discretisation<3>&, int, const PartGeometry<3>&, Triplets&, Triplets&);
template QuadraticProducts<3> quadratic_convection(const Discretisation<3>&, int, const PartGeometry<3>&,
                                                   const VelocityElement<3, 2>::Coefficients&);

} // namespace undula::fom
