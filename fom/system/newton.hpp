// Newton's method for the balance of forces on solids with a nonlinear law, inside one monolithic solve.
#pragma once

#include <functional>
#include <string>

#include "fom/problem/stepping.hpp"
#include "fom/system/linear_system.hpp"

namespace undula::fom {

/// How the unknowns x move the solids: d = rates.d x + offset (cm), v = rates.v x (cm/s).
struct SolidMotion {
  SolidRates rates;
  Eigen::VectorXd offset;
  Eigen::VectorXd balanced; ///< displacements of the last balance that was found, cm
};

/// What else in the system and its right-hand side depends on the answer; nothing where empty.
struct OtherTerms {
  /// Makes both anew about `x`, before every iteration after the first. Collective.
  std::function<void(const Eigen::VectorXd& x)> renew;
  /// What of them does not hold for `x`, the answer that they led to, in words; empty: all does. The same on
  /// every rank. Collective.
  std::function<std::string(const Eigen::VectorXd& x)> missed;
};

/// Answer of all nonlinear solids to `d` and `v`, forces and energy complete on every rank; tangents as in
/// solid_response. Collective.
template <int dim>
SolidResponse<dim> complete_response(const Discretisation<dim>& disc, const Operators<dim>& operators,
                                     const Eigen::VectorXd& d, const Eigen::VectorXd& v,
                                     const SolidRates& rates, bool derive,
                                     const Eigen::VectorXd* before = nullptr);

/// Solves  A x + f(d(x), v(x)) = rhs  from the guess `x`, with A the assembled `system` without tangents and
/// f the internal forces of the nonlinear solids. Rows of constrained unknowns say x = rhs. Returns the
/// iterations taken. What is left of the balance after an iteration is the error of linearising f there;
/// Newton ends when its norm is below tolerance * |f|, or at the rounding of f. With `keep_factors` the
/// iterations after the first correct by GMRES. `others` are made anew in the same iterations, which go on
/// until they hold. Throws NumericsError on every rank, without a place: a law
/// that is not finite, a solid turned inside out, no convergence. `step` as in LinearSystem::solve.
/// Collective.
template <int dim>
int solve_newton(LinearSystem<dim>& system, const Discretisation<dim>& disc, const Operators<dim>& operators,
                 const SolidMotion& motion, const Eigen::VectorXd& rhs, const NewtonSettings& settings,
                 int step, bool keep_factors, Eigen::VectorXd& x, const OtherTerms& others = {});

} // namespace undula::fom
