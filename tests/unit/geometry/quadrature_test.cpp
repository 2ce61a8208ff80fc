#include "geometry/mesh/quadrature.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "rom/base/error.hpp"

namespace undula::geometry {
namespace {

// Integral of prod lambda_i^(a_i) over the simplex of measure 1: n! prod a_i! / (n + sum a_i)!.
template <int dim>
double exact(const std::array<int, dim + 1>& powers) {
  double value = std::tgamma(dim + 1);
  int total = dim;
  for (const int a : powers) {
    value *= std::tgamma(a + 1);
    total += a;
  }
  return value / std::tgamma(total + 1);
}

template <int dim>
void check_exactness(int degree) {
  const auto rule = reference_rule<dim>(degree);
  for (std::size_t q = 0; q < rule.weights.size(); ++q) {
    EXPECT_GT(rule.weights[q], 0);
    EXPECT_GT(rule.barycentric[q].minCoeff(), 0);
    EXPECT_NEAR(rule.barycentric[q].sum(), 1, 1e-14);
  }
  std::array<int, dim + 1> powers{};
  for (;;) {
    int total = 0;
    for (const int a : powers) total += a;
    if (total <= degree) {
      double sum = 0;
      for (std::size_t q = 0; q < rule.weights.size(); ++q) {
        double value = rule.weights[q];
        for (int i = 0; i <= dim; ++i) value *= std::pow(rule.barycentric[q][i], powers[i]);
        sum += value;
      }
      EXPECT_NEAR(sum, exact<dim>(powers), 1e-14) << "degree " << degree;
    }
    int i = 0;
    while (i <= dim && ++powers[i] > degree) powers[i++] = 0;
    if (i > dim) break;
  }
}

TEST(Quadrature, IntegratesEveryMonomialUpToItsDegree) {
  for (int degree = 0; degree <= 12; ++degree) {
    check_exactness<1>(degree);
    check_exactness<2>(degree);
  }
  for (int degree = 0; degree <= 8; ++degree) check_exactness<3>(degree);
}

TEST(Quadrature, IsNotExactBeyondItsDegree) {
  const auto rule = reference_rule<1>(5);
  double sum = 0;
  for (std::size_t q = 0; q < rule.weights.size(); ++q)
    sum += rule.weights[q] * std::pow(rule.barycentric[q][0], 6);
  EXPECT_GT(std::abs(sum - 1.0 / 7), 1e-5);
  EXPECT_EQ(rule.weights.size(), 3u);
}

TEST(Quadrature, RefusesANegativeDegree) { EXPECT_THROW(reference_rule<2>(-1), InputError); }

TEST(Quadrature, TakesTheMeasureOfTheSimplexInSpace) {
  QuadratureSet<2> plane;
  append_simplex_quadrature<2, 1>(reference_rule<1>(1), {Point<2>(1, 1), Point<2>(4, 5)}, plane);
  ASSERT_EQ(plane.weights.size(), 1u);
  EXPECT_NEAR(plane.weights[0], 5, 1e-14);
  EXPECT_NEAR((plane.points[0] - Point<2>(2.5, 3)).norm(), 0, 1e-14);
  append_simplex_quadrature<2, 2>(reference_rule<2>(0), {Point<2>(0, 0), Point<2>(0, 2), Point<2>(3, 0)},
                                  plane);
  ASSERT_EQ(plane.weights.size(), 2u); // appended; a clockwise simplex has positive weights too
  EXPECT_NEAR(plane.weights[1], 3, 1e-14);
  EXPECT_NEAR((plane.points[1] - Point<2>(1, 2.0 / 3)).norm(), 0, 1e-14);

  QuadratureSet<3> space;
  append_simplex_quadrature<3, 2>(reference_rule<2>(0),
                                  {Point<3>(0, 0, 0), Point<3>(0, 2, 0), Point<3>(0, 0, 3)}, space);
  append_simplex_quadrature<3, 3>(
      reference_rule<3>(0), {Point<3>(0, 0, 0), Point<3>(1, 0, 0), Point<3>(0, 2, 0), Point<3>(0, 0, 3)},
      space);
  EXPECT_NEAR(space.weights[0], 3, 1e-14);
  EXPECT_NEAR(space.weights[1], 1, 1e-14);
}

} // namespace
} // namespace undula::geometry
