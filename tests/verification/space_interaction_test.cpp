// A flap in a channel, in space one layer deep between sides of free slip, against the same flap in the
// plane: every coupling.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>

#include "fom/coupling/moving_stepper.hpp"
#include "fom/problem/default_weights.hpp"
#include "tests/verification/support/extruded_mesh.hpp"
#include "tests/verification/support/rectangle_mesh.hpp"

namespace undula::verification {
namespace {

constexpr double flap_left = 1.03, flap_right = 1.19, flap_top = 0.62, depth = 0.1, time_step = 0.02;
constexpr int time_steps = 6;

SimplexMesh<2> channel_plane() {
  return tensor_mesh(spaced(0, 3, 30), spaced(0, 1, 10), {"inlet", "outlet", "floor", "lid"});
}
SimplexMesh<2> flap_plane() {
  return tensor_mesh(spaced(flap_left, flap_right, 2), spaced(-0.05, flap_top, 8), {"a", "b", "c", "d"});
}

constexpr double beyond = 0.05 * depth;

template <int dim>
SimplexMesh<dim> in_depth(const SimplexMesh<2>& plane, double margin) {
  if constexpr (dim == 2)
    return plane;
  else
    return extruded(plane, {-margin, depth + margin}, "front", "back");
}

/// Poisson's ratio is 0, so that a free side of the flap stays where it is.
template <int dim>
FsiProblem<dim> flap_problem() {
  using Kind = typename BoundaryCondition<dim>::Kind;
  FsiProblem<dim> problem;
  problem.fluid = {1, 0.05};
  problem.stabilisation = derived_weights(1.5, time_step);
  problem.background = in_depth<dim>(channel_plane(), 0);
  for (const auto& name : problem.background.boundary_names) problem.boundary[name];
  problem.boundary["inlet"].velocity = [](const Point<dim>& x, double t) -> Point<dim> {
    return 4 * x[1] * (1 - x[1]) * std::min(1.0, t / (time_steps * time_step)) * Point<dim>::Unit(0);
  };
  problem.boundary["outlet"].kind = Kind::opening;
  problem.boundary["outlet"].tangential_zero = false;
  if constexpr (dim == 3)
    for (const char* name : {"front", "back"}) problem.boundary[name].kind = Kind::symmetry;
  SolidBody<dim> flap;
  flap.name = "flap";
  flap.mesh = in_depth<dim>(flap_plane(), beyond);
  // As much mass and stiffness per depth of the fluid.
  const double share = dim == 2 ? 1 : depth / (depth + 2 * beyond);
  flap.properties = {4 * share, 2e3 * share, 0, 0};
  flap.model = SolidModel::saint_venant_kirchhoff;
  flap.imposed = [](const Point<dim>& x) { return x[1] <= 0; };
  problem.solids.push_back(std::move(flap));
  return problem;
}

/// Displacement of the flap's upper corners along the stream, their mean; cm.
template <int dim>
double tip_after(Coupling coupling) {
  CutOptions options;
  options.reproducer_directory = std::filesystem::temp_directory_path().string();
  auto disc = discretise<dim>(flap_problem<dim>(), options);
  PhaseTimer timer;
  auto operators = build_operators<dim>(disc, MPI_COMM_SELF, timer);
  State state = initial_state(disc);
  SteppingSettings settings;
  settings.motion.tolerance = 1e-6;
  if (coupling == Coupling::fixed) {
    TimeStepper<dim> stepper(disc, operators, settings.scheme, time_step, 1, timer);
    for (int step = 0; step < time_steps; ++step) stepper.advance(state);
  } else {
    MovingStepper<dim> stepper(disc, operators, coupling, settings, {}, time_step, timer, state);
    for (int step = 0; step < time_steps; ++step) stepper.advance(state);
  }
  double sum = 0;
  int count = 0;
  const auto& nodes = disc.solid_spaces[0].nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i][1] == flap_top) {
      sum += state.d[0][disc.solid_unknown(0, static_cast<int>(i), 0)];
      ++count;
    }
  return sum / count;
}

class SpaceInteraction : public testing::TestWithParam<Coupling> {};

TEST_P(SpaceInteraction, AFlapOneLayerDeepMovesAsInThePlane) {
  const double plane = tip_after<2>(GetParam()), space = tip_after<3>(GetParam());
  std::printf("flap, %-8s: tip %.5f cm in the plane, %.5f cm in space (%+.2f %%)\n",
              coupling_name(GetParam()), plane, space, 100 * (space / plane - 1));
  EXPECT_GT(plane, 0.005);
  EXPECT_NEAR(space / plane, 1, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Couplings, SpaceInteraction,
                         testing::Values(Coupling::fixed, Coupling::mapped, Coupling::explicit_,
                                         Coupling::implicit));

} // namespace
} // namespace undula::verification
