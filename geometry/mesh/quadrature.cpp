#include "geometry/mesh/quadrature.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "rom/base/error.hpp"

namespace undula::geometry {
namespace {

struct LineRule {
  Eigen::VectorXd nodes;   // in (0, 1)
  Eigen::VectorXd weights; // sum 1
};

// Gauss rule with n nodes for the weight (1 - t)^alpha on [0, 1], normalised; nodes and weights from the
// eigenpairs of the Jacobi matrix of the three-term recurrence (Golub and Welsch 1969).
LineRule gauss_jacobi(int n, int alpha) {
  Eigen::VectorXd diagonal(n);
  Eigen::VectorXd off_diagonal(n - 1);
  for (int j = 0; j < n; ++j) {
    const double s = 2.0 * j + alpha;
    diagonal[j] = alpha == 0 ? 0 : -double(alpha) * alpha / (s * (s + 2));
    if (j > 0)
      off_diagonal[j - 1] = std::sqrt(4.0 * j * j * (j + alpha) * (j + alpha) / (s * s * (s + 1) * (s - 1)));
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal, off_diagonal);
  return {(solver.eigenvalues().array() + 1) / 2, solver.eigenvectors().row(0).array().square()};
}

template <int dim, int k>
double simplex_measure(const std::array<Point<dim>, k + 1>& vertices) {
  if constexpr (k == 1) {
    return (vertices[1] - vertices[0]).norm();
  } else if constexpr (k == 2 && dim == 3) {
    return (vertices[1] - vertices[0]).cross(vertices[2] - vertices[0]).norm() / 2;
  } else {
    static_assert(k == dim);
    Eigen::Matrix<double, dim, dim> edges;
    for (int i = 0; i < dim; ++i) edges.col(i) = vertices[i + 1] - vertices[0];
    return std::abs(edges.determinant()) / (dim == 3 ? 6 : 2);
  }
}

} // namespace

template <int dim>
ReferenceRule<dim> reference_rule(int degree) {
  if (degree < 0)
    throw InputError("the degree of a quadrature rule is negative", std::to_string(degree), "0 or more",
                     "the cut options or the form that asks for the rule");
  const int n = degree / 2 + 1;
  // Collapsed coordinates: lambda_i = t_i prod_{j<i} (1 - t_j), with the Jacobian prod_i (1 - t_i)^(dim-1-i).
  std::array<LineRule, dim> lines;
  for (int i = 0; i < dim; ++i) lines[i] = gauss_jacobi(n, dim - 1 - i);

  ReferenceRule<dim> rule;
  std::array<int, dim> index{};
  for (bool more = true; more;) {
    Eigen::Matrix<double, dim + 1, 1> lambda;
    double rest = 1;
    double weight = 1;
    for (int i = 0; i < dim; ++i) {
      const double t = lines[i].nodes[index[i]];
      lambda[i] = t * rest;
      rest *= 1 - t;
      weight *= lines[i].weights[index[i]];
    }
    lambda[dim] = rest;
    rule.barycentric.push_back(lambda);
    rule.weights.push_back(weight);
    more = false;
    for (int i = 0; i < dim && !more; ++i) {
      more = ++index[i] < n;
      if (!more) index[i] = 0;
    }
  }
  return rule;
}

template <int dim, int k>
void append_simplex_quadrature(const ReferenceRule<k>& rule, const std::array<Point<dim>, k + 1>& vertices,
                               QuadratureSet<dim>& set) {
  const double measure = simplex_measure<dim, k>(vertices);
  for (std::size_t q = 0; q < rule.weights.size(); ++q) {
    Point<dim> x = Point<dim>::Zero();
    for (int i = 0; i <= k; ++i) x += rule.barycentric[q][i] * vertices[i];
    set.points.push_back(x);
    set.weights.push_back(measure * rule.weights[q]);
  }
}

template ReferenceRule<1> reference_rule<1>(int);
template ReferenceRule<2> reference_rule<2>(int);
template ReferenceRule<3> reference_rule<3>(int);
template void append_simplex_quadrature<2, 1>(const ReferenceRule<1>&, const std::array<Point<2>, 2>&,
                                              QuadratureSet<2>&);
template void append_simplex_quadrature<2, 2>(const ReferenceRule<2>&, const std::array<Point<2>, 3>&,
                                              QuadratureSet<2>&);
template void append_simplex_quadrature<3, 1>(const ReferenceRule<1>&, const std::array<Point<3>, 2>&,
                                              QuadratureSet<3>&);
template void append_simplex_quadrature<3, 2>(const ReferenceRule<2>&, const std::array<Point<3>, 3>&,
                                              QuadratureSet<3>&);
template void append_simplex_quadrature<3, 3>(const ReferenceRule<3>&, const std::array<Point<3>, 4>&,
                                              QuadratureSet<3>&);

} // namespace undula::geometry
