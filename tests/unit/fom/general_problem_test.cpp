// Scenes that state their domain, bodies and conditions: what becomes of them.
#include "fom/scene/general_problem.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fom/levels/scene_problem.hpp"
#include "fom/scene/expression.hpp"
#include "fom/scene/scene_file.hpp"
#include "fom/scene/scene_time.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::fom {
namespace {

/// A channel of 40 x 10 mm with a round hole and a square body that is held to the left of x = 21 mm.
Scene channel(const std::vector<std::string>& settings = {}) {
  return parse_scene(R"toml(
name = "channel"
[model]
space = "plane"
[constants]
U = 3.0
[domain]
outline_mm = [[0.0, 10.0], [40.0, 10.0], [40.0, 0.0], [0.0, 0.0]] # clockwise
sides = ["walls", "outlet", "walls", "inlet"]
size_mm = 2.0
[hole.pin]
centre_mm = [10.0, 5.0]
radius_mm = 2.0
[boundary.pin]
size_mm = 0.5
[boundary.inlet]
kind = "velocity"
velocity_cm_per_s = ["U*y*(10 - y)/25", "t"]
[boundary.outlet]
kind = "opening"
pressure_mmHg = "2*ramp(t, 1)"
stress = "static-pressure"
[fluid]
density_g_per_cm3 = 1.0
viscosity_poise = 0.01
[body.block]
outline_mm = [[20.0, 4.0], [22.0, 4.0], [22.0, 6.0], [20.0, 6.0]]
line_mm = [[21.0, 4.0], [21.0, 6.0]]
size_mm = 0.7
density_g_per_cm3 = 1.0
young_dyn_per_cm2 = 1e6
held = "x <= 21"
displacement_mm = ["0", "x*t"]
velocity_cm_per_s = ["1", "y"]
[time]
step_s = 0.01
end_s = 0.105
)toml",
                     "channel", "/", settings);
}

double area(const SimplexMesh<2>& mesh) {
  double sum = 0;
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell)
    sum += cell_measure(mesh, static_cast<int>(cell));
  return sum;
}

TEST(GeneralProblem, MeshesTheDomainWithoutItsHoles) {
  const auto problem = scene_problem(channel());
  // The circle of radius 0.2 cm as a polygon: four times ceil(pi / 2 * 2 / 0.5) = 28 corners.
  const double hole = 0.5 * 28 * 0.04 * std::sin(2 * std::numbers::pi / 28);
  EXPECT_NEAR(area(problem.background), 4.0 - hole, 1e-12);
  double inlet = 0, outlet = 0;
  for (const auto& facet : problem.background.boundary) {
    const auto &a = problem.background.points[facet.points[0]],
               &b = problem.background.points[facet.points[1]];
    const auto& name = problem.background.boundary_names[facet.tag];
    if (name == "inlet") {
      inlet += (b - a).norm();
      EXPECT_EQ(a[0], 0);
    }
    if (name == "outlet") {
      outlet += (b - a).norm();
      EXPECT_EQ(a[0], 4);
    }
  }
  EXPECT_NEAR(inlet, 1, 1e-14);
  EXPECT_NEAR(outlet, 1, 1e-14);
  EXPECT_EQ(problem.boundary.size(), 4u);
  EXPECT_FALSE(problem.pin_pressure);
}

TEST(GeneralProblem, ConditionsAreInCgs) {
  const auto problem = scene_problem(channel());
  const Point<2> u = problem.boundary.at("inlet").velocity({0.0, 0.5}, 7.0);
  EXPECT_NEAR(u[0], 3, 1e-14);
  EXPECT_EQ(u[1], 7);
  const auto& outlet = problem.boundary.at("outlet");
  EXPECT_EQ(outlet.kind, BoundaryCondition<2>::Kind::opening);
  EXPECT_EQ(outlet.opening, OpeningCondition::static_pressure);
  EXPECT_NEAR(outlet.pressure(0.5), units::pressure_from_mmHg(1), 1e-9);
  EXPECT_EQ(problem.boundary.at("walls").kind, BoundaryCondition<2>::Kind::velocity);
  EXPECT_FALSE(problem.boundary.at("walls").velocity);
}

TEST(GeneralProblem, BodiesAreHeldWhereTheySay) {
  const auto problem = scene_problem(channel());
  ASSERT_EQ(problem.solids.size(), 1u);
  const auto& block = problem.solids[0];
  EXPECT_NEAR(area(block.mesh), 0.04, 1e-14);
  EXPECT_TRUE(block.imposed({2.1, 0.5}));
  EXPECT_FALSE(block.imposed({2.11, 0.5}));
  EXPECT_NEAR(block.imposed_displacement({2.1, 0.5}, 2.0)[1], 4.2, 1e-14);
  EXPECT_NEAR(block.initial_velocity({2.1, 0.5}, 0)[1], 5, 1e-14);
}

TEST(GeneralProblem, SlipsByTheLengthOfTheScene) {
  EXPECT_EQ(scene_problem(channel()).slip_length, 0);
  const auto slip = channel({"model.interface=\"slip\"", "contact.slip_length_mm=0.3"});
  EXPECT_NEAR(scene_problem(slip).slip_length, 0.03, 1e-17);
}

TEST(GeneralProblem, TimeIsStatedInSeconds) {
  EXPECT_EQ(time_step(channel()), 0.01);
  EXPECT_EQ(last_step(channel()), 11);
  EXPECT_EQ(last_step(channel({"time.end_s=0.1"})), 10);
}

TEST(GeneralProblem, SpheresAreHalfDiscsOnTheAxis) {
  const auto problem = scene_problem(read_scene(UNDULA_SOURCE_DIR "/data/scenes/sphere_to_wall.toml"));
  double lowest = 1;
  for (const auto& x : problem.solids[0].mesh.points) lowest = std::min(lowest, x[0]);
  EXPECT_EQ(lowest, 0);
  EXPECT_NEAR(area(problem.solids[0].mesh), 0.5 * std::numbers::pi * 0.25, 0.005);
}

TEST(GeneralProblem, WhatCannotBeIsRefused) {
  for (const char* setting :
       {"body.block.density_g_per_cm3=0", "body.block.held=x < 1", "domain.sides=[\"a\", \"b\", \"c\"]",
        "hole.pin.radius_mm=20", "boundary.outlet.kind=wall", "body.block.size=1", "body.blok.size_mm=1",
        "boundary.inlet.velocity_cm_per_s=[\"q\", \"0\"]", "membrane.poisson=0.3", "time.periods=3",
        "model.space=thin-gap", "boundary.pin.size_mm=-1", "body.block.stiffness_damping_s=nan"})
    EXPECT_THROW(scene_problem(channel({setting})), InputError) << setting;
}

TEST(GeneralProblem, TheResolvedSceneReadsBack) {
  const Scene scene = channel({"constants.U=0.1", "boundary.outlet.pressure_mmHg=1.25"});
  const Scene again = parse_scene(scene_to_toml(scene), "recorded", "/");
  EXPECT_EQ(scene_to_toml(again), scene_to_toml(scene));
  EXPECT_EQ(scene_hash(again), scene_hash(scene));
  EXPECT_NE(scene_hash(scene), scene_hash(channel({"boundary.outlet.pressure_mmHg=1.25"})));
}

TEST(Expression, KnowsItsVariablesConstantsAndFunctions) {
  const Expression value("U*x + y^2 + ramp(t, 2) + sin(pi/2)", Space::plane, {{"U", 3}}, "test");
  EXPECT_NEAR(value(2, 0.5, 1), 6 + 0.25 + 0.5 + 1, 1e-14);
  EXPECT_NEAR(Expression("r + 2*z", Space::axisymmetric, {}, "test")(1, 3, 0), 7, 1e-14);
  EXPECT_THROW(Expression("x", Space::axisymmetric, {}, "test"), InputError);
  EXPECT_THROW(Expression("1 +", Space::plane, {}, "test"), InputError);
  EXPECT_THROW(Expression("", Space::plane, {}, "test"), InputError);
  EXPECT_THROW(Expression("1, 2", Space::plane, {}, "test"), InputError);
  EXPECT_THROW(Expression("1/x", Space::plane, {}, "test")(0, 0, 0), NumericsError);
}

TEST(Expression, ComparesButAssignsNothing) {
  for (const char* text : {"x = 20", "y=3", "t >= 1 && x = 2", "x == y = 2"})
    EXPECT_THROW(Expression(text, Space::plane, {}, "test"), InputError) << text;
  for (const char* text : {"x == 20", "x >= 2", "x <= 2", "x != 2", "x == 2 ? 1 : y >= 3"})
    EXPECT_NO_THROW(Expression(text, Space::plane, {}, "test")) << text;
}

} // namespace
} // namespace undula::fom
