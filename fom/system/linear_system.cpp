#include "fom/system/linear_system.hpp"

#include <cmath>
#include <string>

#include "base/error.hpp"

namespace undula {

namespace {

/// Sum of all constant operators with the pattern of the whole, so that the pattern never depends on the
/// factors.
template <int dim>
SparseMatrix constant_part(const Operators<dim>& operators, const SystemFactors& factors) {
  SparseMatrix sum = operators.physical + operators.stabilisation;
  sum = sum + factors.damping * operators.damping;
  sum = sum + factors.mass * operators.mass;
  sum = sum + factors.stiffness * operators.stiffness;
  return sum;
}

} // namespace

template <int dim>
LinearSystem<dim>::LinearSystem(const Discretisation<dim>& disc, const Operators<dim>& operators,
                                int factor_every, PhaseTimer& timer)
    : disc_(disc), operators_(operators), timer_(timer), factor_every_(factor_every) {
  const auto scope = timer_.measure("assemble");
  const auto& index = operators.ownership.petsc_index;
  const int rank = operators.rank;
  const PetscInt own = operators.ownership.first[rank + 1] - operators.ownership.first[rank];
  const PetscInt size = disc.unknowns();

  constant_ = constant_part(operators, {0, 0});
  std::vector<PetscInt> rows, columns;
  const auto add = [&](int row, int column) {
    // Entries of constrained rows are given a negative index, which PETSc skips.
    rows.push_back(disc.is_constrained[row] ? -1 : index[row]);
    columns.push_back(index[column]);
  };
  for (int row = 0; row < constant_.outerSize(); ++row)
    for (SparseMatrix::InnerIterator entry(constant_, row); entry; ++entry)
      add(row, static_cast<int>(entry.col()));
  for (int unknown = 0; unknown < size; ++unknown)
    if (operators.ownership.owner[unknown] == rank) {
      // A diagonal entry for every unknown: 1 for constrained ones, 0 (but in the pattern) for the others.
      rows.push_back(index[unknown]);
      columns.push_back(index[unknown]);
    }
  constant_entries_ = rows.size();
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(size);
  if (disc.problem.flow == FlowModel::navier_stokes)
    visit_convection(disc, operators, zero, [&](int row, int column, double) { add(row, column); });
  tangents_begin_ = rows.size();
  for (const auto& cell : operators.nonlinear_cells) {
    const auto unknowns = cell_unknowns(disc, cell);
    for (const int column : unknowns)
      for (const int row : unknowns) add(row, column);
  }
  values_.assign(rows.size(), 0.0);

  check_petsc(MatCreate(operators.comm, matrix_.out()), "creating the system matrix");
  check_petsc(MatSetSizes(matrix_.get(), own, own, size, size), "sizing the system matrix");
  check_petsc(MatSetType(matrix_.get(), MATAIJ), "typing the system matrix");
  check_petsc(MatSetPreallocationCOO(matrix_.get(), static_cast<PetscCount>(rows.size()), rows.data(),
                                     columns.data()),
              "preallocating the system matrix");
  check_petsc(MatCreateVecs(matrix_.get(), solution_.out(), rhs_.out()), "creating vectors");
  check_petsc(VecScatterCreateToAll(solution_.get(), gather_.out(), gathered_.out()), "creating the gather");

  const bool corrects = factor_every > 1 || operators.has_nonlinear_solid;
  check_petsc(KSPCreate(operators.comm, solver_.out()), "creating the solver");
  check_petsc(KSPSetOptionsPrefix(solver_.get(), "fsi_"), "naming the solver");
  check_petsc(KSPSetType(solver_.get(), corrects ? KSPGMRES : KSPPREONLY), "choosing the solver");
  check_petsc(KSPSetTolerances(solver_.get(), 1e-11, 1e-300, 1e10, 200), "setting tolerances");
  PC preconditioner = nullptr;
  check_petsc(KSPGetPC(solver_.get(), &preconditioner), "getting the preconditioner");
  check_petsc(PCSetType(preconditioner, PCLU), "choosing LU");
  check_petsc(PCFactorSetMatSolverType(preconditioner, MATSOLVERMUMPS), "choosing MUMPS");
  check_petsc(KSPSetOperators(solver_.get(), matrix_.get(), matrix_.get()), "setting the operator");
  check_petsc(KSPSetFromOptions(solver_.get()), "reading -fsi_ options");
}

template <int dim>
void LinearSystem<dim>::assemble(const SystemFactors& factors, const Eigen::VectorXd* b) {
  const auto scope = timer_.measure("assemble");
  if (!factors_ || !(*factors_ == factors)) {
    constant_ = constant_part(operators_, factors);
    std::copy(constant_.valuePtr(), constant_.valuePtr() + constant_.nonZeros(), values_.begin());
    auto value = values_.begin() + constant_.nonZeros();
    for (int unknown = 0; unknown < disc_.unknowns(); ++unknown)
      if (operators_.ownership.owner[unknown] == operators_.rank)
        *value++ = disc_.is_constrained[unknown] ? 1.0 : 0.0;
    factors_ = factors;
    factored_at_ = -1;
  }
  std::size_t next = constant_entries_;
  if (b && tangents_begin_ > constant_entries_)
    visit_convection(disc_, operators_, *b, [&](int, int, double value) { values_[next++] = value; });
  std::fill(values_.begin() + static_cast<std::ptrdiff_t>(next), values_.end(), 0.0);
  check_petsc(MatSetValuesCOO(matrix_.get(), values_.data(), INSERT_VALUES), "filling the system matrix");
}

template <int dim>
void LinearSystem<dim>::replace_tangents(
    const std::vector<typename CellResponse<dim>::Derivatives>& tangents) {
  const auto scope = timer_.measure("assemble");
  auto value = values_.begin() + static_cast<std::ptrdiff_t>(tangents_begin_);
  for (const auto& tangent : tangents)
    value = std::copy(tangent.data(), tangent.data() + tangent.size(), value);
  check_petsc(MatSetValuesCOO(matrix_.get(), values_.data(), INSERT_VALUES), "filling the system matrix");
}

template <int dim>
Eigen::VectorXd LinearSystem<dim>::solve(const Eigen::VectorXd& rhs, int step, int iteration) {
  const auto& index = operators_.ownership.petsc_index;
  const int first = operators_.ownership.first[operators_.rank];
  {
    double* values = nullptr;
    check_petsc(VecGetArray(rhs_.get(), &values), "writing the right-hand side");
    for (int unknown = 0; unknown < disc_.unknowns(); ++unknown)
      if (operators_.ownership.owner[unknown] == operators_.rank)
        values[index[unknown] - first] = rhs[unknown];
    check_petsc(VecRestoreArray(rhs_.get(), &values), "writing the right-hand side");
  }
  bool reuse = false;
  {
    const auto scope = timer_.measure("factor");
    reuse = factored_at_ >= 0 && (iteration > 1 || (step - 1) % factor_every_ != 0);
    check_petsc(KSPSetReusePreconditioner(solver_.get(), reuse ? PETSC_TRUE : PETSC_FALSE),
                "reusing the factors");
    // Without new operators KSPSetUp would leave the factorisation to KSPSolve, and its time to phase
    // "solve".
    check_petsc(KSPSetOperators(solver_.get(), matrix_.get(), matrix_.get()), "setting the operator");
    check_petsc(KSPSetUp(solver_.get()), "factoring the system");
    if (!reuse) factored_at_ = step;
  }
  const auto scope = timer_.measure("solve");
  check_petsc(KSPSolve(solver_.get(), rhs_.get(), solution_.get()), "solving the system");
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  check_petsc(KSPGetConvergedReason(solver_.get(), &reason), "asking the solver");
  if (reason < 0 && reuse && iteration > 1) {
    // The solids have moved too far from where the factors were made.
    check_petsc(KSPSetReusePreconditioner(solver_.get(), PETSC_FALSE), "factoring anew");
    check_petsc(KSPSetOperators(solver_.get(), matrix_.get(), matrix_.get()), "setting the operator");
    check_petsc(KSPSolve(solver_.get(), rhs_.get(), solution_.get()), "solving the system");
    check_petsc(KSPGetConvergedReason(solver_.get(), &reason), "asking the solver");
  }
  check_petsc(
      VecScatterBegin(gather_.get(), solution_.get(), gathered_.get(), INSERT_VALUES, SCATTER_FORWARD),
      "gathering");
  check_petsc(VecScatterEnd(gather_.get(), solution_.get(), gathered_.get(), INSERT_VALUES, SCATTER_FORWARD),
              "gathering");
  Eigen::VectorXd x(disc_.unknowns());
  const double* values = nullptr;
  check_petsc(VecGetArrayRead(gathered_.get(), &values), "reading the solution");
  for (int unknown = 0; unknown < disc_.unknowns(); ++unknown) x[unknown] = values[index[unknown]];
  check_petsc(VecRestoreArrayRead(gathered_.get(), &values), "reading the solution");
  // Every rank holds the same x and the same reason, so all of them throw or none does.
  if (reason < 0 || !x.allFinite())
    throw NumericsError(
        reason < 0 ? "the linear solver stopped with PETSc reason " + std::to_string(reason)
                   : std::string("the solution of the linear system is not finite"),
        "step " + std::to_string(step),
        "a smaller time step (time.steps_per_period), a smaller stroke, or -fsi_ solver options");
  return x;
}

template class LinearSystem<2>;

} // namespace undula
