// Sparse non-negative least squares against the conditions of its optimum.
#include "training/moving_domain/nonnegative_fit.hpp"

#include <gtest/gtest.h>

#include <random>

namespace undula::training {
namespace {

struct Problem {
  Eigen::MatrixXd columns;
  Eigen::VectorXd target;
  NonnegativeFit fit(double tolerance, int most) const {
    return nonnegative_fit(columns.transpose() * columns, columns.transpose() * target, target.squaredNorm(),
                           tolerance, most);
  }
};

Eigen::MatrixXd random_matrix(int rows, int columns, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd matrix(rows, columns);
  for (Eigen::Index k = 0; k < matrix.size(); ++k) matrix.data()[k] = normal(generator);
  return matrix;
}

TEST(NonnegativeFit, FindsTheFewColumnsThatATargetIsMadeOf) {
  Problem problem;
  problem.columns = random_matrix(60, 200, 1);
  problem.target = 3 * problem.columns.col(7) + 0.5 * problem.columns.col(120) + problem.columns.col(199);
  const auto fit = problem.fit(1e-8, 50);
  EXPECT_LT(fit.error, 1e-7);
  EXPECT_NEAR(fit.weights[7], 3, 1e-6);
  EXPECT_NEAR(fit.weights[120], 0.5, 1e-6);
  EXPECT_NEAR(fit.weights[199], 1, 1e-6);
  EXPECT_GE(fit.weights.minCoeff(), 0);
}

// Karush, Kuhn and Tucker: the gradient vanishes in columns with a weight and pushes the others below zero.
TEST(NonnegativeFit, IsTheOptimumWhereNoneIsExact) {
  for (const unsigned seed : {2U, 3U, 4U}) {
    Problem problem;
    problem.columns = random_matrix(80, 40, seed);
    problem.target = random_matrix(80, 1, seed + 10);
    const auto fit = problem.fit(0, 40);
    const Eigen::VectorXd left = problem.columns * fit.weights - problem.target;
    EXPECT_NEAR(fit.error, left.norm() / problem.target.norm(), 1e-8);
    const Eigen::VectorXd gradient = problem.columns.transpose() * left;
    int at_zero = 0;
    for (Eigen::Index k = 0; k < gradient.size(); ++k) {
      if (fit.weights[k] > 0) {
        EXPECT_NEAR(gradient[k], 0, 1e-9);
      } else {
        EXPECT_GT(gradient[k], -1e-9);
        ++at_zero;
      }
    }
    EXPECT_GT(at_zero, 5); // or the bound did nothing
    EXPECT_EQ(fit.columns, 40 - at_zero);
  }
}

TEST(NonnegativeFit, StopsAtTheErrorAskedForAndAtTheMostColumns) {
  Problem problem;
  problem.columns = random_matrix(60, 300, 5).cwiseAbs();
  problem.target = problem.columns.rowwise().sum();
  const auto rough = problem.fit(0.05, 300), fine = problem.fit(0.005, 300);
  EXPECT_LE(rough.error, 0.05);
  EXPECT_LE(fine.error, 0.005);
  EXPECT_LT(rough.columns, fine.columns);
  EXPECT_LE(problem.fit(0, 5).columns, 5);
}

TEST(NonnegativeFit, TakesColumnsThatDependOnEachOther) {
  Problem problem;
  problem.columns = random_matrix(30, 20, 6);
  problem.columns.rightCols(10) = problem.columns.leftCols(10);
  problem.target = problem.columns.leftCols(3).rowwise().sum();
  EXPECT_LT(problem.fit(1e-9, 20).error, 1e-6);
}

} // namespace
} // namespace undula::training
