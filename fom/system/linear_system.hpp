// The monolithic linear system of one step: PETSc matrix with a fixed pattern, factored by MUMPS or, in space
// from a size on, solved by FGMRES with a preconditioner by blocks.
#pragma once

#include <optional>

#include "fom/system/block_preconditioner.hpp"
#include "fom/system/handles.hpp"
#include "fom/system/operators.hpp"
#include "fom/system/reduced_solver.hpp"

namespace undula::fom {

/// Factors of the operators in the system matrix
///   mass * mass + physical + stabilisation + damping * damping + stiffness * (stiffness + added) +
///   convection(b) + jumps(b),
/// `added` the stiffness of forces that are no part of the operators (contact), and what the matrix has
/// besides.
struct SystemFactors {
  double mass = 0;
  double stiffness = 0;
  double damping = 1; ///< 0 at rest, where the unknowns of solids are displacements
  double holder = 0;  ///< force of a driven holder on its surroundings per velocity, dyn s/cm
  bool operator==(const SystemFactors&) const = default;
};

/// Rows of constrained unknowns are replaced by the identity, but for those of a driven holder: they are
/// summed up in the row of the first, and the rows of the others say that they have its value. With a reduced
/// space (Discretisation::reduced) every solution is that of the projected system. Options of the
/// solver are open to the user under the prefix `-fsi_`. The symbolic factorisation is made once.
///
/// Time steps in space with more than `largest_factored` unknowns are solved by FGMRES on the true residual
/// (block_preconditioner.hpp); -fsi_solver direct or blocks decides otherwise.
template <int dim>
class LinearSystem {
public:
  /// Collective. `factor_every` > 1 keeps a numerical factorisation for at most that many steps and corrects
  /// by GMRES. So do the iterations of one step, where it takes several: with nonlinear solids, or
  /// `iterates`.
  LinearSystem(const Discretisation<dim>& disc, const Operators<dim>& operators, int factor_every,
               PhaseTimer& timer, bool iterates = false);

  /// Sets the values for convecting field `b` (null: no convection). Nonlinear solids need `replace_tangents`
  /// before the next solution. Phase "assemble". Collective.
  void assemble(const SystemFactors& factors, const Eigen::VectorXd* b);

  /// To be called when the operators' values have changed in place, as after a new map of the domain: the
  /// next `assemble` reads all of them. Pattern and symbolic factorisation stay. Collective; throws
  /// NumericsError on every rank if an entry has no place in the pattern.
  void refresh();

  /// Adds a stiffness to that of the operators (this rank's share; null: none, as at first) until another one
  /// takes its place, from the next `assemble` on; factors are kept where the pattern has places for it, else
  /// pattern and symbolic factorisation are made anew. It has to outlive its use. Collective.
  void add_stiffness(const SparseMatrix* added);

  /// Replaces the tangents of the share's nonlinear cells and nothing else. Phase "assemble". Collective.
  void replace_tangents(const std::vector<typename CellResponse<dim>::Derivatives>& tangents);

  /// Solves with the natural-order right-hand side (complete on every rank), solution complete on every rank.
  /// Phases "factor" and "solve". Throws NumericsError on every rank if the solver fails, x is not finite, or
  /// the true residual is not small, whatever the solver's options.
  /// `step` decides when to factor anew: the first step after a multiple of factor_every does, so that a
  /// restart from a state at such a multiple repeats the run; in between, a step after one in which GMRES did
  /// not get on with the old factors. From Newton's second `iteration` of a step on the factors stay as long
  /// as it does, from `guess` if one is given.
  /// Where GMRES corrects old factors it goes on to `tolerance`, of the preconditioned right-hand side.
  Eigen::VectorXd solve(const Eigen::VectorXd& rhs, int step, int iteration = 1,
                        const Eigen::VectorXd* guess = nullptr, double tolerance = linear_tolerance);

  /// The tolerance of answers that nothing corrects afterwards.
  static constexpr double linear_tolerance = 1e-11;
  /// The same of solutions by blocks: of the right-hand side, the rows of continuity scaled to weigh as much
  /// as those of momentum.
  static constexpr double block_tolerance = 1e-9;
  /// In space: larger time steps are solved by blocks (docs/space.md tells what each takes).
  static constexpr int largest_factored = 20000;

  /// Whether the last solution was by blocks, and the iterations of GMRES or FGMRES that it took.
  bool by_blocks() const { return blocks_.has_value(); }
  int iterations() const { return iterations_; }

  Mat matrix() const { return matrix_.get(); }

private:
  void prepare(); ///< the pattern and what rests on it
  void collect_pattern();
  bool all_have(bool on_this_rank) const;
  int place_of(int row, int column) const;
  bool has_places_for(const SparseMatrix& matrix) const;
  void add_constant(const SparseMatrix& matrix, double factor);
  void renew_constants();
  void sum_constant_terms(const SystemFactors& factors);
  void fill(Vec vector, const Eigen::VectorXd& values); ///< with this rank's share of them
  void write(std::vector<double>& values);              ///< with what the constrained rows say
  void check_residual(int step);
  void make_solver();
  bool wants_blocks() const;
  void set_row_scale();

  const Discretisation<dim>& disc_;
  const Operators<dim>& operators_;
  PhaseTimer& timer_;
  int factor_every_;
  int factored_at_ = -1;
  bool iterates_;                                 ///< see the constructor
  PetscInt most_iterations_ = 0;                  ///< that -fsi_ options allow
  int iterations_ = 0;                            ///< of the last solution
  double stated_tolerance_ = linear_tolerance;    ///< the same
  bool worn_ = false;                             ///< GMRES has needed as long as new factors take
  std::vector<int> row_begin_, columns_;          ///< pattern of this rank's share, natural numbering
  std::vector<int> flow_places_, tangent_places_; ///< of visited entries in the pattern, in their order
  std::vector<double> constant_;                  ///< for the current factors, by place in the pattern
  std::vector<double> without_tangents_;          ///< with convection and jumps
  std::vector<int> identity_places_;              ///< of the diagonal of constrained rows
  std::vector<double> holder_entries_;            ///< that follow those of the pattern, of a driven holder
  int holder_place_ = -1; ///< of SystemFactors::holder in them, on the rank that has it
  const SparseMatrix* added_stiffness_ = nullptr;
  std::optional<SystemFactors> factors_; ///< of `constant_`
  bool stale_ = false;                   ///< whether the operators have changed since
  std::optional<ReducedSolver> reduced_; ///< in place of PETSc's objects, which then are not made
  std::vector<double> values_;           ///< of the matrix to be projected
  std::optional<UnknownBlocks> blocks_;  ///< where the system is solved by blocks
  bool split_ = false;                   ///< whether the preconditioner by blocks is made
  bool scaled_ = false;                  ///< whether the matrix is that of the scaled rows
  PetscVec row_scale_;                   ///< of a system solved by blocks, 1 but for rows of continuity
  PetscMat matrix_;
  PetscVec rhs_, solution_, gathered_, residual_;
  PetscScatter gather_;
  PetscSolver solver_;
};

} // namespace undula::fom
