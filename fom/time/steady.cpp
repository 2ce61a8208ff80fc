#include "fom/time/steady.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "fom/time/step_parts.hpp"
#include "fom/time/time_stepper.hpp"
#include "rom/base/error.hpp"

namespace undula::fom {

namespace {

/// The steady state under the loads and imposed values `rhs`, from `x`, which a failure leaves as it was;
/// `balanced`: the one under the loads before.
template <int dim>
int steady_at_load(LinearSystem<dim>& system, const Discretisation<dim>& disc,
                   const Operators<dim>& operators, const Eigen::VectorXd& rhs, double tolerance,
                   int max_iterations, const LoadPath& path, const std::string& place,
                   const Eigen::VectorXd& balanced, Eigen::VectorXd& x) {
  const SolidMotion at_rest{{1.0, 0.0}, Eigen::VectorXd::Zero(disc.unknowns()), balanced};
  Eigen::VectorXd last = x;
  double change = 0;
  int solves = 0;
  for (int iteration = 1; iteration <= max_iterations; ++iteration) {
    system.assemble({0.0, 1.0, 0.0}, &last);
    Eigen::VectorXd next = last;
    if (operators.has_nonlinear_solid) {
      try {
        solves += solve_newton(system, disc, operators, at_rest, rhs, path.newton, iteration, false, next);
      } catch (const NumericsError& error) {
        throw NumericsError(std::string("the steady state was not reached: ") + error.what(), place,
                            "more load steps (LoadPath::load_steps), or more iterations");
      }
    } else {
      next = system.solve(rhs, iteration);
      ++solves;
    }
    change = (next - last).norm() / std::max(next.norm(), 1e-300);
    last = std::move(next);
    if (change < tolerance || disc.problem.flow == FlowModel::stokes) {
      x = std::move(last);
      return solves;
    }
  }
  throw NumericsError(
      "the Picard iteration for the steady state did not converge",
      std::to_string(max_iterations) + " iterations, relative change " + std::to_string(change),
      "a time-dependent run, or more iterations");
}

} // namespace

template <int dim>
int solve_steady(const Discretisation<dim>& disc, const Operators<dim>& operators, double tolerance,
                 int max_iterations, PhaseTimer& timer, Eigen::VectorXd& x, const LoadPath& path) {
  bool elastic = false;
  for (int unknown = disc.fluid_unknowns(); unknown < disc.unknowns(); ++unknown)
    elastic = elastic || !disc.is_constrained[unknown];
  if (elastic && !disc.cut.interface.empty())
    throw InputError("the steady state of elastic solids in a fluid is not computed directly",
                     "solids with nodes that are free to move, in contact with fluid",
                     "imposed solids in a fluid, or solids in vacuo; otherwise a run in time",
                     "FsiProblem::solids");
  if (has_skin_forces(disc.problem))
    throw InputError("loads on skins and contact have no steady state that is computed directly",
                     "FsiProblem::loads or FsiProblem::pairs", "a run in time", "FsiProblem");
  LinearSystem<dim> system(disc, operators, 1, timer);
  Eigen::VectorXd full = loads_at(disc, operators, 0.0);
  for (const auto& constrained : disc.constrained)
    full[constrained.unknown] = imposed_fluid_value(constrained, 0.0);
  for (const auto& node : disc.imposed)
    full.template segment<dim>(node.unknown) = imposed_displacement(disc, node, 0.0);
  const int load_steps = operators.has_nonlinear_solid ? path.load_steps : 1;
  int solves = 0;
  Eigen::VectorXd before = x;
  for (int load = 1; load <= load_steps; ++load) {
    const Eigen::VectorXd rhs = full * (static_cast<double>(load) / load_steps);
    Eigen::VectorXd next = x;
    if (load > 1) next += x - before; // along the path so far
    solves +=
        steady_at_load(system, disc, operators, rhs, tolerance, max_iterations, path,
                       "load step " + std::to_string(load) + " of " + std::to_string(load_steps), x, next);
    before = std::exchange(x, std::move(next));
  }
  return solves;
}

template <int dim>
Eigen::VectorXd steady_residual(const Discretisation<dim>& disc, const Operators<dim>& operators,
                                const Eigen::VectorXd& x) {
  Eigen::VectorXd sum = operators.physical * x + operators.stabilisation * x + operators.stiffness * x +
                        convection_of(disc, operators, x, x) + jumps_of(disc, operators, x, x);
  sum_over_ranks(operators.comm, sum);
  if (operators.has_nonlinear_solid)
    sum += complete_response<dim>(disc, operators, x, Eigen::VectorXd::Zero(x.size()), {}, false).elastic;
  return sum - loads_at(disc, operators, 0.0);
}

template int solve_steady(const Discretisation<2>&, const Operators<2>&, double, int, PhaseTimer&,
                          Eigen::VectorXd&, const LoadPath&);
template Eigen::VectorXd steady_residual(const Discretisation<2>&, const Operators<2>&,
                                         const Eigen::VectorXd&);

template int solve_steady(const Discretisation<3>&, const Operators<3>&, double, int, PhaseTimer&,
                          Eigen::VectorXd&, const LoadPath&);
template Eigen::VectorXd steady_residual(const Discretisation<3>&, const Operators<3>&,
                                         const Eigen::VectorXd&);

} // namespace undula::fom
