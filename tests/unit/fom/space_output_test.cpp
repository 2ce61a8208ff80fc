// What is drawn of a state in space, and the film between a body and walls there.
#include <gtest/gtest.h>

#include "fom/contact/wall_contact.hpp"
#include "fom/output/visual_mesh.hpp"
#include "geometry/mesh/box_mesh.hpp"

namespace undula::fom {
namespace {

constexpr double block_volume = 0.6 * 0.5 * 0.3;

/// A cube of fluid [0, 1]^3 between walls with a block that stands `gap` above z = 0.
Discretisation<3> block_above_floor(double gap, int order = 1) {
  FsiProblem<3> problem;
  problem.fluid = {1, 0.1};
  problem.velocity_order = order;
  problem.background = box_mesh({Point<3>::Zero(), Point<3>::Ones()}, {3, 3, 3});
  for (const auto& name : problem.background.boundary_names) problem.boundary[name];
  SolidBody<3> block;
  block.mesh = box_mesh({{0.2, 0.2, gap}, {0.8, 0.7, gap + 0.3}}, {3, 2, 2});
  block.properties = {1, 1e5, 0.3};
  problem.solids.push_back(block);
  return discretise<3>(problem, {});
}

double volume_of(const FieldMesh<3>& mesh) {
  SimplexMesh<3> plain{mesh.points, mesh.cells, {}, {}};
  double volume = 0;
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    const double one = cell_measure(plain, static_cast<int>(cell));
    EXPECT_GT(one, 0);
    volume += one;
  }
  return volume;
}

TEST(SpacePicture, FillsFluidAndSolids) {
  for (const int order : {1, 2}) {
    const auto disc = block_above_floor(0.1, order);
    const auto fluid = fluid_picture(disc);
    EXPECT_NEAR(volume_of(fluid.mesh), 1 - block_volume, 1e-9);
    const auto solid = solid_picture(disc);
    EXPECT_NEAR(volume_of(solid), block_volume, 1e-12);
    EXPECT_EQ(solid.cells.size(), 8 * disc.problem.solids[0].mesh.cells.size());
  }
}

/// A field that the elements hold is drawn as it is, wherever the points of the picture are.
TEST(SpacePicture, CarriesTheFieldsOfAState) {
  for (const int order : {1, 2}) {
    const auto disc = block_above_floor(0.1, order);
    const auto velocity = [&](const Point<3>& x) -> Point<3> {
      const double square = order == 2 ? x[0] * x[1] - x[2] * x[2] : 0;
      return {x[0] - 2 * x[1] + square, 1 + x[2], x[1] - square};
    };
    State state = initial_state(disc);
    for (int node = 0; node < disc.velocity_nodes(); ++node)
      state.x[0].segment<3>(disc.velocity_unknown(node, 0)) = velocity(disc.velocity_position(node));
    for (int node = 0; node < disc.vertex_nodes(); ++node)
      state.x[0][disc.pressure_unknown(node)] = disc.velocity_position(node).sum();
    const auto picture = fluid_picture(disc);
    const auto fields = fluid_fields(disc, picture, state);
    ASSERT_EQ(fields[0].components, 3);
    for (std::size_t p = 0; p < picture.mesh.points.size(); ++p) {
      const auto& x = picture.mesh.points[p];
      const Eigen::Map<const Point<3>> drawn(fields[0].values.data() + 3 * p);
      EXPECT_LT((drawn - velocity(x)).norm(), 1e-11);
      EXPECT_NEAR(fields[1].values[p], x.sum(), 1e-11);
    }
  }
}

const ContactSettings film{0.02, 300.0, 0.0};

TEST(SpaceContact, GapsToFacesEdgesAndCorners) {
  const auto contact = prepare_contact(block_above_floor(0.1), film);
  const auto above = gap_to_walls<3>(contact, {0.4, 0.35, 0.03});
  EXPECT_NEAR(above.distance, 0.03, 1e-12);
  EXPECT_NEAR(above.direction[2], 1, 1e-12);
  EXPECT_NEAR(gap_to_walls<3>(contact, {0.4, 0.35, -0.03}).distance, -0.03, 1e-12);
  EXPECT_NEAR(gap_to_walls<3>(contact, {0.4, -0.3, -0.4}).distance, -0.5, 1e-12);  // beyond an edge
  EXPECT_NEAR(gap_to_walls<3>(contact, {-0.2, -0.3, -0.6}).distance, -0.7, 1e-12); // beyond a corner
  EXPECT_NEAR(gap_to_walls<3>(contact, {0.4, 1.2, 0.5}).direction[1], -1, 1e-12);
}

TEST(SpaceContact, TheFilmPressesOnTheSkinBelow) {
  const auto disc = block_above_floor(0.1);
  const auto contact = prepare_contact(disc, film);
  Eigen::VectorXd placement = Eigen::VectorXd::Zero(disc.solid_unknowns());
  EXPECT_NEAR(smallest_gap(contact, placement), 0.1, 1e-12);
  EXPECT_EQ(contact_force(contact, disc, placement).nodes, 0);
  for (Eigen::Index i = 2; i < placement.size(); i += 3) placement[i] = -0.09; // gap 0.01
  const auto force = contact_force(contact, disc, placement);
  EXPECT_GT(force.nodes, 10);
  Eigen::VectorXd displacement = Eigen::VectorXd::Zero(disc.unknowns());
  displacement.tail(disc.solid_unknowns()) = placement;
  const Eigen::VectorXd acting = force.load - force.stiffness * displacement;
  Point<3> sum = Point<3>::Zero();
  for (int u = disc.fluid_unknowns(); u < disc.unknowns(); u += 3) sum += acting.segment<3>(u);
  EXPECT_NEAR(sum[2], 300.0 * 0.6 * 0.5, 1e-9);
  EXPECT_NEAR(sum.head<2>().norm(), 0, 1e-9);
}

} // namespace
} // namespace undula::fom
