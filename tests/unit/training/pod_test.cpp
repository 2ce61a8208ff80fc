#include "training/reduction/pod.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "fom/system/handles.hpp"
#include "rom/base/error.hpp"
#include "training/training.hpp"

namespace undula::training {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// P1 mass matrix of a graded line with n points: symmetric positive definite, entries vary by 100.
Eigen::SparseMatrix<double> mass_matrix(int n) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i + 1 < n; ++i) {
    const double h = 0.01 + double(i) / n;
    entries.emplace_back(i, i, h / 3), entries.emplace_back(i + 1, i + 1, h / 3);
    entries.emplace_back(i, i + 1, h / 6), entries.emplace_back(i + 1, i, h / 6);
  }
  Eigen::SparseMatrix<double> mass(n, n);
  mass.setFromTriplets(entries.begin(), entries.end());
  return mass;
}

MatrixXd random_matrix(int rows, int columns, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); });
}

MatrixXd orthonormal(const MatrixXd& a) {
  return Eigen::HouseholderQR<MatrixXd>(a).householderQ() * MatrixXd::Identity(a.rows(), a.cols());
}

/// Modified Gram-Schmidt, twice, in the inner product.
MatrixXd weighted_orthonormal(MatrixXd a, const Eigen::SparseMatrix<double>& w) {
  for (int pass = 0; pass < 2; ++pass)
    for (int j = 0; j < a.cols(); ++j) {
      for (int i = 0; i < j; ++i) a.col(j) -= a.col(i) * a.col(i).dot(w * a.col(j));
      a.col(j) /= std::sqrt(a.col(j).dot(w * a.col(j)));
    }
  return a;
}

double projection_error_squared(const MatrixXd& x, const MatrixXd& v, const Eigen::SparseMatrix<double>& w) {
  MatrixXd rest = x;
  for (int pass = 0; pass < 2; ++pass) rest -= v * (v.transpose() * (w * rest));
  return (rest.transpose() * (w * rest)).trace();
}

double orthonormality_defect(const MatrixXd& v, const Eigen::SparseMatrix<double>& w) {
  return (v.transpose() * (w * v) - MatrixXd::Identity(v.cols(), v.cols())).cwiseAbs().maxCoeff();
}

/// Snapshots U diag(10^-k) Q^T with W-orthonormal U and orthogonal Q: everything about their POD is known.
struct Known {
  Eigen::SparseMatrix<double> mass = mass_matrix(120);
  VectorXd sigma;
  MatrixXd modes, snapshots;
  Known(int count, double decades_per_mode) : sigma(count) {
    for (int k = 0; k < count; ++k) sigma[k] = 3 * std::pow(10, -k * decades_per_mode);
    modes = weighted_orthonormal(random_matrix(120, count, 1), mass);
    snapshots = modes * sigma.asDiagonal() * orthonormal(random_matrix(40, count, 2)).transpose();
  }
};

TEST(Pod, FindsKnownModesDownToTheRoundOffOfTheLargest) {
  const Known known(12, 1); // singular values from 3 to 3e-11
  const auto basis = pod(known.snapshots, known.mass, {});
  ASSERT_GE(basis.singular_values.size(), 12);
  for (int k = 0; k < 12; ++k)
    EXPECT_NEAR(basis.singular_values[k], known.sigma[k], 1e-14 * known.sigma[0]) << k;
  EXPECT_LT(orthonormality_defect(basis.modes, known.mass), 1e-13);
  for (int k = 0; k < 12; ++k) {
    const double alignment = std::abs(known.modes.col(k).dot(known.mass * basis.modes.col(k)));
    EXPECT_NEAR(alignment, 1, 1e-3) << k; // the method of snapshots alone is lost from k = 8 on
  }
  EXPECT_NEAR(basis.energy, known.sigma.squaredNorm(), 1e-13 * basis.energy);
}

TEST(Pod, TailEnergyIsTheProjectionError) {
  const Known known(20, 0.25);
  for (const int kept : {1, 3, 8, 15}) {
    const auto basis = pod(known.snapshots, known.mass, {.max_modes = kept});
    ASSERT_EQ(basis.modes.cols(), kept);
    const double tail = known.sigma.tail(20 - kept).squaredNorm();
    const double round_off = 1e-28 * basis.energy;
    EXPECT_NEAR(basis.tail_energy, tail, 1e-9 * tail + round_off);
    EXPECT_NEAR(projection_error_squared(known.snapshots, basis.modes, known.mass), tail,
                1e-9 * tail + round_off);
    EXPECT_NEAR(basis.captured_energy, 1 - tail / known.sigma.squaredNorm(), 1e-14);
    EXPECT_LT(orthonormality_defect(basis.modes, known.mass), 1e-13);
  }
}

TEST(Pod, KeepsTheFewestModesWithinTheTolerance) {
  const Known known(20, 0.25);
  const double energy = known.sigma.squaredNorm();
  for (int kept = 1; kept < 15; ++kept) {
    const double tail = known.sigma.tail(20 - kept).squaredNorm() / energy;
    const double below = known.sigma.tail(20 - kept - 1).squaredNorm() / energy;
    EXPECT_EQ(pod(known.snapshots, known.mass, {.energy_tolerance = 1.001 * tail}).modes.cols(), kept);
    EXPECT_EQ(pod(known.snapshots, known.mass, {.energy_tolerance = 0.5 * (tail + below)}).modes.cols(),
              kept + 1);
  }
  EXPECT_EQ(pod(known.snapshots, known.mass, {.max_modes = 4, .energy_tolerance = 1e-9}).modes.cols(), 4);
}

TEST(Pod, DoesNotDependOnTheOrderOfTheSnapshots) {
  const Known known(10, 0.3);
  std::vector<int> order(40);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(5));
  MatrixXd shuffled(known.snapshots.rows(), 40);
  for (int j = 0; j < 40; ++j) shuffled.col(j) = known.snapshots.col(order[j]);
  const auto a = pod(known.snapshots, known.mass, {.max_modes = 6});
  const auto b = pod(shuffled, known.mass, {.max_modes = 6});
  EXPECT_LT((a.singular_values.head(6) - b.singular_values.head(6)).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LT((a.modes - b.modes).cwiseAbs().maxCoeff(), 1e-9 * a.modes.cwiseAbs().maxCoeff());
}

TEST(Pod, HandlesRepeatedSnapshotsAndManyEqualSingularValues) {
  const auto mass = mass_matrix(120);
  const MatrixXd u = weighted_orthonormal(random_matrix(120, 6, 3), mass);
  MatrixXd repeated(120, 30);
  for (int j = 0; j < 30; ++j) repeated.col(j) = u.col(j % 6);
  const auto basis = pod(repeated, mass, {});
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(basis.singular_values[k], std::sqrt(5), 1e-13);
  EXPECT_LT(orthonormality_defect(basis.modes, mass), 1e-13);
  EXPECT_LT(projection_error_squared(repeated, basis.modes, mass), 1e-27);
  // With a tolerance above round-off the rank is found.
  EXPECT_EQ(pod(repeated, mass, {.energy_tolerance = 1e-12}).modes.cols(), 6);
}

TEST(Pod, WorksInASemidefiniteInnerProduct) {
  // W = diag(1, .., 1, 0, .., 0) sees the first 60 entries only.
  Eigen::SparseMatrix<double> w(120, 120);
  for (int i = 0; i < 60; ++i) w.insert(i, i) = 1;
  const MatrixXd x = random_matrix(120, 5, 4);
  const auto basis = pod(x, w, {});
  ASSERT_EQ(basis.modes.cols(), 5);
  EXPECT_LT(orthonormality_defect(basis.modes, w), 1e-13);
  EXPECT_NEAR(basis.energy, x.topRows(60).squaredNorm(), 1e-12 * basis.energy);
  EXPECT_LT(projection_error_squared(x, basis.modes, w), 1e-26);
}

TEST(Pod, RefusesWhatHasNoDecomposition) {
  const auto mass = mass_matrix(10);
  MatrixXd x = random_matrix(10, 3, 6);
  EXPECT_THROW(pod(random_matrix(9, 3, 6), mass, {}), InputError);
  EXPECT_THROW(pod(MatrixXd(10, 0), mass, {}), InputError);
  EXPECT_THROW(pod(x, mass, {.energy_tolerance = 1}), InputError);
  EXPECT_THROW(pod(MatrixXd::Zero(10, 3), mass, {}), NumericsError);
  Eigen::SparseMatrix<double> indefinite = mass;
  indefinite.coeffRef(4, 4) = -0.3;
  EXPECT_THROW(pod(MatrixXd::Identity(10, 10), indefinite, {}), NumericsError);
  x(2, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(pod(x, mass, {}), NumericsError);
}

// The rows distributed over the ranks give the same modes as all rows on one.
TEST(PodMpi, AgreesWithOneRank) {
  const Known known(10, 0.5);
  const int n = static_cast<int>(known.mass.rows());
  PetscMat matrix;
  check_petsc(
      MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, n, n, 3, nullptr, 3, nullptr, matrix.out()),
      "MatCreateAIJ");
  PetscInt begin = 0, end = 0;
  MatGetOwnershipRange(matrix.get(), &begin, &end);
  for (int i = begin; i < end; ++i)
    for (int j = std::max(0, i - 1); j <= std::min(n - 1, i + 1); ++j)
      MatSetValue(matrix.get(), i, j, known.mass.coeff(i, j), INSERT_VALUES);
  MatAssemblyBegin(matrix.get(), MAT_FINAL_ASSEMBLY);
  MatAssemblyEnd(matrix.get(), MAT_FINAL_ASSEMBLY);
  const auto whole = pod(known.snapshots, known.mass, {.max_modes = 8});
  const auto split = pod(known.snapshots.middleRows(begin, end - begin), matrix.get(), {.max_modes = 8});
  ASSERT_EQ(split.modes.rows(), end - begin);
  EXPECT_LT((whole.singular_values.head(8) - split.singular_values.head(8)).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LT((whole.modes.middleRows(begin, end - begin) - split.modes).cwiseAbs().maxCoeff(), 1e-7);
}

} // namespace
} // namespace undula::training
