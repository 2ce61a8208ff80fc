// Cook's membrane in plane strain, nearly incompressible: no locking on coarse meshes.
#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <cstdio>
#include <vector>

#include "fom/system/operators.hpp"
#include "tests/verification/support/eigenmodes.hpp"
#include "tests/verification/support/names.hpp"
#include "tests/verification/support/solid_meshes.hpp"

namespace undula::verification {
namespace {

constexpr double shear_modulus = 80.1938, end_load = 100.0; // the customary data, in any consistent units

/// Rise of the upper right corner: the tapered panel (0,0), (48,44), (48,60), (0,44), clamped on the left,
/// sheared by a uniform traction on the right, n x n quadrilaterals.
double corner_rise(int n, double poisson) {
  SolidBody<2> body;
  body.mesh = tensor_mesh(spaced(0, 1, n), spaced(0, 1, n));
  for (auto& x : body.mesh.points) x = Point<2>(48 * x[0], 44 * x[0] + x[1] * (44 - 28 * x[0]));
  body.properties = {1.0, 2 * (1 + poisson) * shear_modulus, poisson, 0.0};
  body.imposed = [](const Point<2>& x) { return x[0] == 0; };
  const auto disc = discretise(in_vacuo(Space::plane, body), CutOptions{});
  PhaseTimer timer;
  const auto operators = build_operators(disc, PETSC_COMM_SELF, timer);

  // Uniform traction on the quadratic edges: 1/6, 4/6, 1/6 of each edge's load.
  Eigen::VectorXd load = Eigen::VectorXd::Zero(disc.unknowns());
  for (const auto& facet : body.mesh.boundary) {
    if (facet.tag != 1) continue;
    const auto &a = body.mesh.points[facet.points[0]], &b = body.mesh.points[facet.points[1]];
    const double force = end_load * (b - a).norm() / 16;
    for (const int corner : facet.points) load[disc.solid_unknown(0, corner, 1)] += force / 6;
    load[disc.solid_unknown(0, node_at(disc, 0, 0.5 * (a + b)), 1)] += force * 4 / 6;
  }
  const FreeUnknowns free(disc.is_constrained);
  Eigen::VectorXd reduced(free.size());
  for (int i = 0; i < free.size(); ++i) reduced[i] = load[free.natural[i]];
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(
      Eigen::SparseMatrix<double>(free.restrict_to_free(operators.stiffness)));
  return free.extend(solver.solve(reduced))[disc.solid_unknown(0, node_at(disc, 0, {48, 60}), 1)];
}

/// The rise and its errors relative to the limit of n = 8, 16, 32 (Aitken): the clamped corner is singular,
/// so the meshes converge slower than the element's order.
struct Convergence {
  double limit = 0;
  std::vector<double> errors; ///< of n = 2, 4, 8, 16, 32
};

Convergence converge(double poisson) {
  std::vector<double> rise;
  for (const int n : {2, 4, 8, 16, 32}) rise.push_back(corner_rise(n, poisson));
  Convergence result;
  result.limit = (rise[2] * rise[4] - rise[3] * rise[3]) / (rise[2] + rise[4] - 2 * rise[3]);
  std::printf("Cook, nu = %.4f: limit %.4f;", poisson, result.limit);
  for (std::size_t i = 0; i < rise.size(); ++i) {
    result.errors.push_back(rise[i] / result.limit - 1);
    std::printf(" n = %d: %+.2f %%", 2 << i, 100 * result.errors.back());
  }
  std::printf("\n");
  return result;
}

/// Locking is an error that grows without bound, or to all of the solution, as nu -> 1/2. Here it does not
/// depend on nu: from 0.49 to 0.4999 the bulk modulus grows a hundredfold, and every mesh keeps its error.
TEST(CookMembrane, DoesNotLock) {
  const auto soft = converge(0.49), hard = converge(0.4999);
  for (std::size_t i = 0; i < soft.errors.size(); ++i) {
    EXPECT_LT(soft.errors[i], 0); // too stiff, never too soft
    EXPECT_LT(std::abs(hard.errors[i]), 1.25 * std::abs(soft.errors[i])) << "n = " << (2 << i);
  }
  EXPECT_LT(std::abs(hard.errors[1]), 0.08);
  EXPECT_LT(std::abs(hard.errors[2]), 0.03);
  EXPECT_LT(std::abs(hard.errors[3]), 0.012);
  EXPECT_NEAR(hard.limit / soft.limit, 1, 0.03);
}

} // namespace
} // namespace undula::verification
