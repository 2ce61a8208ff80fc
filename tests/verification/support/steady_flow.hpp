// Solves a manufactured flow on the unit square, or meridian square, around an optional solid at rest.
#pragma once

#include <filesystem>
#include <optional>

#include "fom/time/steady.hpp"
#include "fom/time/time_stepper.hpp"
#include "tests/verification/support/flow_errors.hpp"
#include "tests/verification/support/names.hpp"
#include "tests/verification/support/rectangle_mesh.hpp"

namespace undula::verification {

/// Quadrature good enough not to show beside the errors of a manufactured flow.
inline CutOptions fine_quadrature() { return {6, 6, 4, std::filesystem::temp_directory_path().string()}; }

/// The flow with its exact values on the sides, its force inside, and `solid` held in place. In axisymmetric
/// space the side "left" is the axis.
inline FsiProblem<2> manufactured_problem(const ManufacturedFlow& flow, SimplexMesh<2> background,
                                          const std::optional<SimplexMesh<2>>& solid,
                                          const StabilisationWeights& weights) {
  FsiProblem<2> problem;
  problem.space = flow.space;
  problem.flow = flow.convects ? FlowModel::navier_stokes : FlowModel::stokes;
  problem.fluid = {flow.density, flow.viscosity};
  problem.background = std::move(background);
  problem.stabilisation = weights;
  problem.pin_pressure = true;
  problem.body_force = [flow](const Point<2>& x, double) { return sample(flow, x).force; };
  for (const auto& name : problem.background.boundary_names) {
    auto& condition = problem.boundary[name];
    if (flow.space == Space::axisymmetric && name == "left")
      condition.kind = BoundaryCondition<2>::Kind::symmetry;
    else
      condition.velocity = [flow](const Point<2>& x, double) { return velocity_at(flow, x); };
  }
  if (solid) {
    SolidBody<2> body;
    body.name = "solid";
    body.mesh = *solid;
    body.properties = {1, 1, 0.3, 0};
    body.imposed = [](const Point<2>&) { return true; };
    problem.solids.push_back(std::move(body));
  }
  return problem;
}

inline FlowErrors solve_manufactured(const ManufacturedFlow& flow, const FsiProblem<2>& problem) {
  PhaseTimer timer;
  const auto disc = discretise<2>(problem, fine_quadrature());
  const auto operators = build_operators<2>(disc, MPI_COMM_SELF, timer);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(disc.unknowns());
  solve_steady<2>(disc, operators, 1e-7, 60, timer, x);
  return flow_errors(disc, x, flow);
}

} // namespace undula::verification
