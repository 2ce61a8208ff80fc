// Navier's slip law in the interface terms.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "fom/system/operators.hpp"
#include "tests/verification/support/channel_problem.hpp"

namespace undula::fom {
namespace {

using namespace verification;

/// Symmetric part of all forms that are linear in the velocities and pressures; twice its quadratic form is
/// what they dissipate.
Eigen::MatrixXd dissipation(Space space, double slip_length) {
  auto problem = channel_with_plate(space);
  problem.slip_length = slip_length;
  const auto disc = discretise(std::move(problem), CutOptions{});
  PhaseTimer timer;
  const auto operators = build_operators(disc, MPI_COMM_SELF, timer);
  const Eigen::MatrixXd forms =
      Eigen::MatrixXd(operators.physical) + Eigen::MatrixXd(operators.stabilisation);
  return forms + forms.transpose();
}

class Slip : public testing::TestWithParam<Space> {};

TEST_P(Slip, DissipatesWhateverTheLength) {
  for (const double length : {0.0, 1e-4, 1e-2, 1.0, 1e6}) {
    const auto form = dissipation(GetParam(), length);
    const auto eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(form, Eigen::EigenvaluesOnly).eigenvalues();
    EXPECT_GT(eigenvalues[0], -1e-12 * eigenvalues[eigenvalues.size() - 1]) << "slip length " << length;
  }
}

/// The plate alone moves along itself, in still fluid. Nitsche's terms resist with the power of the length
/// they hold: mu / (k + L) per area, k = h / penalty, so that 1 / power grows by L / (mu * area * speed^2).
TEST_P(Slip, AddsItsLengthToThatOfThePenalty) {
  const auto power = [&](double length, const Point<2>& velocity) {
    auto problem = channel_with_plate(GetParam());
    problem.slip_length = length;
    // Every element of the structured background has the same diameter, so the same penalty.
    const auto disc = discretise(std::move(problem), CutOptions{});
    PhaseTimer timer;
    const auto operators = build_operators(disc, MPI_COMM_SELF, timer);
    Eigen::VectorXd x = interpolate_velocity(disc, [&](const Point<2>&) { return velocity; });
    x.head(disc.fluid_unknowns()).setZero();
    return x.dot(operators.stabilisation * x);
  };
  const Point<2> along(1, 0);
  // The two rims of the plate are pushed, not rubbed, whatever the length: power of a skin without friction.
  const double pushed = power(1e12, along), length = 0.02;
  const double held = power(0, along) - pushed, slipping = power(length, along) - pushed;
  using Sizes = ChannelSizes;
  const bool round = GetParam() == Space::axisymmetric;
  const double inner = Sizes::plate_inner, outer = Sizes::plate_outer;
  const double faces = 2 * (round ? std::numbers::pi * (outer * outer - inner * inner) : outer - inner);
  EXPECT_NEAR(1 / slipping - 1 / held, length / (0.05 * faces), 1e-6 * length / (0.05 * faces));
}

INSTANTIATE_TEST_SUITE_P(Spaces, Slip, testing::Values(Space::plane, Space::axisymmetric),
                         [](const auto& instance) {
                           return instance.param == Space::axisymmetric ? "Axisymmetric" : "Plane";
                         });

} // namespace
} // namespace undula::fom
