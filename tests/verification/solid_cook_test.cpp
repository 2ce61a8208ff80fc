// Cook's membrane in plane strain, nearly incompressible: no locking on coarse meshes.
#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <cstdio>
#include <vector>

#include "fom/system/operators.hpp"
#include "tests/verification/support/cook_membrane.hpp"
#include "tests/verification/support/eigenmodes.hpp"
#include "tests/verification/support/names.hpp"

namespace undula::verification {
namespace {

/// Rise of the upper right corner, n x n quadrilaterals.
double corner_rise(int n, double poisson) {
  const auto body = cook_panel(tensor_mesh(spaced(0, 1, n), spaced(0, 1, n)), poisson);
  const auto disc = discretise(in_vacuo(Space::plane, body), CutOptions{});
  PhaseTimer timer;
  const auto operators = build_operators(disc, PETSC_COMM_SELF, timer);

  const Eigen::VectorXd load = cook_load(disc);
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
