// The monolithic linear system of one step: PETSc matrix with a fixed pattern, MUMPS by default.
#pragma once

#include <optional>

#include "fom/petsc/handles.hpp"
#include "fom/system/operators.hpp"

namespace undula {

/// Factors of the operators in the system matrix
///   mass_factor * mass + physical + stabilisation + damping + stiffness_factor * stiffness + convection(b).
struct SystemFactors {
  double mass = 0;
  double stiffness = 0;
  bool operator==(const SystemFactors&) const = default;
};

/// Rows of constrained unknowns are replaced by the identity. Options of the solver are open to the user
/// under the prefix `-fsi_`. The symbolic factorisation is made once.
template <int dim>
class LinearSystem {
public:
  /// Collective. `factor_every` > 1 keeps a numerical factorisation for that many steps and corrects by
  /// GMRES.
  LinearSystem(const Discretisation<dim>& disc, const Operators<dim>& operators, int factor_every,
               PhaseTimer& timer);

  /// Sets the values for convecting field `b` (null: no convection). Phase "assemble". Collective.
  void assemble(const SystemFactors& factors, const Eigen::VectorXd* b);

  /// Solves with the natural-order right-hand side (complete on every rank), solution complete on every rank.
  /// Phases "factor" and "solve". Throws NumericsError on every rank if the solver fails or x is not finite.
  /// `step` decides when to factor anew: the first step after a multiple of factor_every does, so that a
  /// restart from a state at such a multiple repeats the run.
  Eigen::VectorXd solve(const Eigen::VectorXd& rhs, int step);

  Mat matrix() const { return matrix_.get(); }

private:
  const Discretisation<dim>& disc_;
  const Operators<dim>& operators_;
  PhaseTimer& timer_;
  int factor_every_;
  int factored_at_ = -1;
  std::vector<double> values_; ///< constant entries, then convection entries
  std::size_t constant_entries_ = 0;
  SparseMatrix constant_; ///< for the current factors
  std::optional<SystemFactors> factors_;
  PetscMat matrix_;
  PetscVec rhs_, solution_, gathered_;
  PetscScatter gather_;
  PetscSolver solver_;
};

} // namespace undula
