#include "fom/system/newton.hpp"

#include <cstdio>
#include <limits>
#include <string>

#include "rom/base/error.hpp"

namespace undula::fom {

namespace {

std::string scientific(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", value);
  return text;
}

[[noreturn]] void give_up(const std::string& what, int iteration, double error) {
  throw NumericsError("Newton's method for the solids failed: " + what,
                      "iteration " + std::to_string(iteration) + ", forces out of balance by " +
                          scientific(error) + " of the internal forces",
                      "a smaller load or time step, or a better-shaped solid mesh");
}

} // namespace

namespace {

[[noreturn]] void not_settled(const std::string& missed, int iterations) {
  throw NumericsError("the equations of a step did not settle: " + missed,
                      std::to_string(iterations) + " iterations", "a smaller time step");
}

/// The iterations of `others` alone, where all solids are linear.
template <int dim>
int solve_others(LinearSystem<dim>& system, const Eigen::VectorXd& rhs, int most, int step, bool keep_factors,
                 Eigen::VectorXd& x, const OtherTerms& others) {
  std::string missed;
  for (int iteration = 1; iteration <= most; ++iteration) {
    if (iteration > 1 && others.renew) others.renew(x);
    x = system.solve(rhs, step, keep_factors ? iteration : 1, &x);
    if (others.missed) missed = others.missed(x);
    if (missed.empty()) return iteration;
  }
  not_settled(missed, most);
}

} // namespace

template <int dim>
SolidResponse<dim> complete_response(const Discretisation<dim>& disc, const Operators<dim>& operators,
                                     const Eigen::VectorXd& d, const Eigen::VectorXd& v,
                                     const SolidRates& rates, bool derive, const Eigen::VectorXd* before) {
  auto response = solid_response(disc, operators.nonlinear_cells, d, v, rates, derive, before);
  sum_over_ranks(operators.comm, response.elastic);
  sum_over_ranks(operators.comm, response.viscous);
  Eigen::VectorXd energy = Eigen::VectorXd::Constant(1, response.energy);
  sum_over_ranks(operators.comm, energy);
  response.energy = energy[0];
  MPI_Allreduce(MPI_IN_PLACE, &response.smallest_volume_ratio, 1, MPI_DOUBLE, MPI_MIN, operators.comm);
  return response;
}

template <int dim>
int solve_newton(LinearSystem<dim>& system, const Discretisation<dim>& disc, const Operators<dim>& operators,
                 const SolidMotion& motion, const Eigen::VectorXd& rhs, const NewtonSettings& settings,
                 int step, bool keep_factors, Eigen::VectorXd& x, const OtherTerms& others) {
  if (!operators.has_nonlinear_solid)
    return solve_others(system, rhs, settings.max_iterations, step, keep_factors, x, others);
  const auto& cells = operators.nonlinear_cells;
  // Only the unknowns of solids enter, and only balances that are asked for count.
  const auto free = [&](Eigen::VectorXd values) {
    constrain_rows(disc, values);
    return values;
  };
  const auto displacement = [&](const Eigen::VectorXd& y) -> Eigen::VectorXd {
    return motion.rates.d * y + motion.offset;
  };
  Eigen::VectorXd before = motion.balanced;
  const auto respond = [&](const Eigen::VectorXd& y, bool derive) {
    return complete_response<dim>(disc, operators, displacement(y), motion.rates.v * y, motion.rates, derive,
                                  &before);
  };
  const auto product = [&](const SolidResponse<dim>& response, const Eigen::VectorXd& y, bool absolute) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(disc.unknowns());
    add_tangent_product(disc, cells, response, y, absolute, sum);
    sum_over_ranks(operators.comm, sum);
    return sum;
  };

  // What GMRES leaves over must not keep Newton from its tolerance: 0.1 of it did.
  constexpr double correction = 1e-3;
  double error = std::numeric_limits<double>::infinity();
  std::string missed;
  for (int iteration = 1; iteration <= settings.max_iterations; ++iteration) {
    if (iteration > 1 && others.renew) others.renew(x);
    const auto here = respond(x, true);
    const Eigen::VectorXd force = here.elastic + here.viscous;
    if (!force.allFinite()) give_up("the law is not finite, an element is inside out", iteration, error);
    system.replace_tangents(here.tangents);
    Eigen::VectorXd next = system.solve(rhs + free(product(here, x, false) - force), step,
                                        keep_factors ? iteration : 1, &x, correction * settings.tolerance);
    const Eigen::VectorXd linear = force + product(here, next - x, false);
    const double rounding = 4 * std::numeric_limits<double>::epsilon() *
                            product(here, displacement(next), true).norm() / motion.rates.d;
    before = displacement(x);
    x = std::move(next);
    const auto there = respond(x, false);
    const Eigen::VectorXd exact = there.elastic + there.viscous;
    if (!exact.allFinite()) give_up("the law is not finite, an element is inside out", iteration, error);
    const double left = free(exact - linear).norm();
    error = left / std::max(exact.norm(), std::numeric_limits<double>::min());
    if (others.missed) missed = others.missed(x);
    if (left > settings.tolerance * exact.norm() + rounding || !missed.empty()) continue;
    if (there.smallest_volume_ratio <= 0) give_up("an element is inside out", iteration, error);
    return iteration;
  }
  if (!missed.empty()) not_settled(missed, settings.max_iterations);
  give_up("no convergence", settings.max_iterations, error);
}

template SolidResponse<2> complete_response(const Discretisation<2>&, const Operators<2>&,
                                            const Eigen::VectorXd&, const Eigen::VectorXd&, const SolidRates&,
                                            bool, const Eigen::VectorXd*);
template int solve_newton(LinearSystem<2>&, const Discretisation<2>&, const Operators<2>&, const SolidMotion&,
                          const Eigen::VectorXd&, const NewtonSettings&, int, bool, Eigen::VectorXd&,
                          const OtherTerms&);

template SolidResponse<3> complete_response(const Discretisation<3>&, const Operators<3>&,
                                            const Eigen::VectorXd&, const Eigen::VectorXd&, const SolidRates&,
                                            bool, const Eigen::VectorXd*);
template int solve_newton(LinearSystem<3>&, const Discretisation<3>&, const Operators<3>&, const SolidMotion&,
                          const Eigen::VectorXd&, const NewtonSettings&, int, bool, Eigen::VectorXd&,
                          const OtherTerms&);

} // namespace undula::fom
