#include "fom/contact/wall_contact.hpp"

#include <gtest/gtest.h>

#include "tests/verification/support/solid_meshes.hpp"

namespace undula::fom {
namespace {

using verification::box;

const ContactSettings film{0.02, 300.0, 0.0};

/// A square of fluid [0, 1]^2 between walls, with a block over 0.2 < x < 0.8 that stands `gap` above the
/// bottom.
Discretisation<2> block_above_wall(double gap) {
  FsiProblem<2> problem;
  problem.fluid = {1.0, 0.1};
  problem.background = verification::warped_square(4);
  for (const auto& name : problem.background.boundary_names) problem.boundary[name];
  SolidBody<2> block;
  block.mesh = box({0.2, gap}, {0.8, 0.4}, 6, 2);
  block.properties = {1.0, 1e5, 0.3};
  problem.solids.push_back(block);
  return discretise(std::move(problem), {});
}

TEST(FilmPressure, IsABarrierWithATangentBelow) {
  EXPECT_EQ(film_pressure(film, 0.021).pressure, 0);
  EXPECT_NEAR(film_pressure(film, 0.01).pressure, 300.0, 1e-9);
  EXPECT_NEAR(film_pressure(film, 0.002).pressure, 2700.0, 1e-9);
  for (const double gap : {0.015, 0.002, 0.0011, 0.0009, -0.01}) {
    const double step = 1e-8;
    const double slope =
        (film_pressure(film, gap + step).pressure - film_pressure(film, gap - step).pressure) / (2 * step);
    EXPECT_NEAR(film_pressure(film, gap).slope / slope, 1, 1e-5) << gap;
  }
  EXPECT_GT(film_pressure(film, -0.01).pressure, film_pressure(film, 0.0).pressure);
}

TEST(GapToWalls, IsNegativeOutsideAndPointsInside) {
  const auto contact = prepare_contact(block_above_wall(0.1), film);
  const auto inside = gap_to_walls<2>(contact, {0.4, 0.03});
  EXPECT_NEAR(inside.distance, 0.03, 1e-12);
  EXPECT_NEAR(inside.direction[1], 1, 1e-12);
  const auto outside = gap_to_walls<2>(contact, {0.4, -0.03});
  EXPECT_NEAR(outside.distance, -0.03, 1e-12);
  EXPECT_NEAR(outside.direction[1], 1, 1e-12);
  EXPECT_NEAR(gap_to_walls<2>(contact, {-0.3, -0.4}).distance, -0.5, 1e-12); // beyond a corner
  EXPECT_NEAR(gap_to_walls<2>(contact, {1.2, 0.5}).direction[0], -1, 1e-12);
}

TEST(ContactForce, IsThePressureOfTheFilmOnTheSkinBelow) {
  const auto disc = block_above_wall(0.1);
  const auto contact = prepare_contact(disc, film);
  Eigen::VectorXd placement = Eigen::VectorXd::Zero(disc.solid_unknowns());
  EXPECT_NEAR(smallest_gap(contact, placement), 0.1, 1e-12);
  EXPECT_EQ(contact_force(contact, disc, placement).nodes, 0);
  for (Eigen::Index i = 1; i < placement.size(); i += 2) placement[i] = -0.09; // gap 0.01
  const auto force = contact_force(contact, disc, placement);
  Eigen::VectorXd at = Eigen::VectorXd::Zero(disc.unknowns());
  at.tail(placement.size()) = placement;
  const Eigen::VectorXd pushed = force.load - force.stiffness * at;
  Point<2> sum = Point<2>::Zero();
  for (Eigen::Index i = disc.fluid_unknowns(); i < disc.unknowns(); i += 2) sum += pushed.segment<2>(i);
  EXPECT_NEAR(sum[0], 0, 1e-9);
  EXPECT_NEAR(sum[1], 0.6 * 300.0, 1e-9); // length * stiffness * (film / gap - 1)
  // Consistent with its linearisation: another 1e-5 down.
  Eigen::VectorXd lower = placement, further = at;
  for (Eigen::Index i = 1; i < lower.size(); i += 2) lower[i] -= 1e-5;
  further.tail(lower.size()) = lower;
  double linear = 0, exact = 0;
  const auto there = contact_force(contact, disc, lower);
  for (Eigen::Index i = disc.fluid_unknowns() + 1; i < disc.unknowns(); i += 2) {
    linear += (force.load - force.stiffness * further)[i];
    exact += (there.load - there.stiffness * further)[i];
  }
  EXPECT_NEAR((linear - sum[1]) / (exact - sum[1]), 1, 2e-3);
}

TEST(PrepareContact, LeavesOutWhereASolidIsAttached) {
  const auto free = prepare_contact(block_above_wall(0.1), film);
  const auto attached = prepare_contact(block_above_wall(0.0), film);
  EXPECT_EQ(free.skin.size(), attached.skin.size() + 13); // the quadratic nodes of the six edges below
  EXPECT_NEAR(smallest_gap(attached, Eigen::VectorXd::Zero(1000)), 0.1, 1e-12);
}

} // namespace
} // namespace undula::fom
