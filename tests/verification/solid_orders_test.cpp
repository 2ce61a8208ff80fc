// Orders of the quadratic solid by a manufactured displacement, plane and axisymmetric.
#include <gtest/gtest.h>

#include <cstdio>

#include "fom/time/steady.hpp"
#include "fom/time/time_stepper.hpp"
#include "tests/verification/support/names.hpp"
#include "tests/verification/support/solid_meshes.hpp"

namespace undula::verification {
namespace {

/// d = (A sin(ax) cos(bz), B cos(ax) sin(bz)), zero along x on the axis, and the body force that holds it.
struct ManufacturedDisplacement {
  static constexpr double A = 0.7, B = -1.1, a = 2.0, b = 1.5;
  bool hoop;
  double young = 3.0, poisson = 0.49;

  Point<2> value(const Point<2>& x) const {
    return {A * std::sin(a * x[0]) * std::cos(b * x[1]), B * std::cos(a * x[0]) * std::sin(b * x[1])};
  }
  /// (i, j) = d_j of component i.
  Eigen::Matrix2d gradient(const Point<2>& x) const {
    const double s = std::sin(a * x[0]), c = std::cos(a * x[0]), sz = std::sin(b * x[1]),
                 cz = std::cos(b * x[1]);
    Eigen::Matrix2d g;
    g << A * a * c * cz, -A * b * s * sz, -B * a * s * sz, B * b * c * cz;
    return g;
  }
  /// -(lambda + mu) grad div d - mu Laplace d.
  Point<2> force(const Point<2>& x) const {
    const double lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson)),
                 shear = young / (2 * (1 + poisson));
    const double s = std::sin(a * x[0]), c = std::cos(a * x[0]), sz = std::sin(b * x[1]),
                 cz = std::cos(b * x[1]);
    const Point<2> d = value(x);
    const double in_plane = A * a + B * b;
    Point<2> grad_div(-in_plane * a * s * cz, -in_plane * b * c * sz);
    Point<2> laplace = -(a * a + b * b) * d;
    if (hoop) {
      const double r = x[0];
      grad_div += Point<2>(A * cz * (a * c / r - s / (r * r)), -A * b * s * sz / r);
      const auto g = gradient(x);
      laplace += Point<2>(g(0, 0) / r - d[0] / (r * r), g(1, 0) / r);
    }
    return -(lame + shear) * grad_div - shear * laplace;
  }
};

struct Errors {
  double l2 = 0, h1 = 0;
};

Errors solve_and_measure(const ManufacturedDisplacement& exact, int n) {
  SolidBody<2> body;
  body.mesh = warped_square(n);
  body.properties = {1.0, exact.young, exact.poisson, 0.0};
  body.imposed = [](const Point<2>& x) { return x.minCoeff() <= 0 || x.maxCoeff() >= 1; };
  body.imposed_displacement = [&](const Point<2>& x, double) { return exact.value(x); };
  body.body_force = [&](const Point<2>& x, double) { return exact.force(x); };
  const auto disc =
      discretise(in_vacuo(exact.hoop ? Space::axisymmetric : Space::plane, std::move(body)), CutOptions{});
  PhaseTimer timer;
  const auto operators = build_operators(disc, PETSC_COMM_SELF, timer);
  Eigen::VectorXd d = Eigen::VectorXd::Zero(disc.unknowns());
  solve_steady(disc, operators, 1e-10, 1, timer, d);

  Errors sums;
  const auto rule = reference_rule<2>(8);
  const auto& mesh = disc.problem.solids[0].mesh;
  const Measure measure = measure_of(disc.problem.space);
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell)
    for (std::size_t q = 0; q < rule.weights.size(); ++q) {
      Point<2> x = Point<2>::Zero();
      for (int k = 0; k < 3; ++k) x += rule.barycentric[q][k] * mesh.points[mesh.cells[cell][k]];
      const auto shape = quadratic_values<2>(rule.barycentric[q]);
      const auto g =
          quadratic_gradients<2>(rule.barycentric[q], barycentric_gradients(mesh, static_cast<int>(cell)));
      Point<2> value = Point<2>::Zero();
      Eigen::Matrix2d gradient = Eigen::Matrix2d::Zero();
      const auto& nodes = disc.solid_spaces[0].cell_nodes[cell];
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        const Point<2> nodal = d.segment<2>(disc.solid_unknown(0, nodes[k], 0));
        value += shape[k] * nodal;
        gradient += nodal * g.col(k).transpose();
      }
      const double w = rule.weights[q] * cell_measure(mesh, static_cast<int>(cell)) * measure(x[0]);
      sums.l2 += w * (value - exact.value(x)).squaredNorm();
      sums.h1 += w * (gradient - exact.gradient(x)).squaredNorm();
    }
  return {std::sqrt(sums.l2), std::sqrt(sums.h1)};
}

class SolidOrders : public testing::TestWithParam<Space> {};

TEST_P(SolidOrders, AreThreeInL2AndTwoInH1) {
  const bool axisymmetric = GetParam() == Space::axisymmetric;
  const ManufacturedDisplacement exact{axisymmetric};
  Errors coarse = solve_and_measure(exact, 8);
  for (const int n : {16, 32}) {
    const auto fine = solve_and_measure(exact, n);
    const double l2 = std::log2(coarse.l2 / fine.l2), h1 = std::log2(coarse.h1 / fine.h1);
    std::printf("%s solid, nu = 0.49, n = %d: L2 %.3e (order %.2f), H1 %.3e (order %.2f)\n",
                axisymmetric ? "axisymmetric" : "plane", n, fine.l2, l2, fine.h1, h1);
    EXPECT_GT(l2, 2.85);
    EXPECT_GT(h1, 1.9);
    coarse = fine;
  }
  EXPECT_LT(coarse.l2, 1e-4); // of a displacement of order one: it is this field that is approached
}

INSTANTIATE_TEST_SUITE_P(Spaces, SolidOrders, testing::Values(Space::plane, Space::axisymmetric),
                         [](const auto& instance) {
                           return instance.param == Space::axisymmetric ? "Axisymmetric" : "Plane";
                         });

} // namespace
} // namespace undula::verification
