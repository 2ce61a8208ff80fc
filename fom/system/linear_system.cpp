#include "fom/system/linear_system.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <numeric>
#include <string>
#include <utility>

#include "rom/base/error.hpp"

namespace undula::fom {

namespace {

/// The operators with a factor in the system matrix.
template <int dim>
std::array<std::pair<const SparseMatrix*, double>, 5> constant_terms(const Operators<dim>& operators,
                                                                     const SystemFactors& factors) {
  return {{{&operators.physical, 1.0},
           {&operators.stabilisation, 1.0},
           {&operators.damping, factors.damping},
           {&operators.mass, factors.mass},
           {&operators.stiffness, factors.stiffness}}};
}

/// Iterations of GMRES: at most, with factors of the same matrix; and with older ones, beyond which the
/// answer is taken from new factors. Factoring costs about ten iterations, so that factors which needed more
/// than `worthwhile_corrections` have served their time.
constexpr PetscInt most_corrections = 200, most_corrections_of_old = 25, worthwhile_corrections = 10;

/// Directions that FGMRES keeps.
constexpr PetscInt restart_of_blocks = 60;

/// Of the right-hand side. Direct solves leave 1e-10, where cuts leave tiny parts up to 1e-5; an answer to
/// another system is wrong by more than all of it.
constexpr double largest_residual = 1e-2;

/// While it lives, MUMPS orders new factors by approximate minimum fill, unless an option says otherwise.
/// Finding that order takes a fifth of the time of nested dissection, with a little more fill: right where a
/// pattern serves one step. PETSc 3.18 loses what MatMumpsSetIcntl sets before the factors are begun, so it
/// goes by the option.
class QuickOrdering {
public:
  QuickOrdering() {
    PetscBool stated = PETSC_FALSE;
    check_petsc(PetscOptionsHasName(nullptr, nullptr, option, &stated), "asking for an option");
    if (stated) return;
    check_petsc(PetscOptionsSetValue(nullptr, option, minimum_fill), "choosing the ordering");
    set_ = true;
  }
  ~QuickOrdering() {
    if (set_) (void)PetscOptionsClearValue(nullptr, option);
  }
  QuickOrdering(const QuickOrdering&) = delete;
  QuickOrdering& operator=(const QuickOrdering&) = delete;

private:
  static constexpr const char* option = "-fsi_mat_mumps_icntl_7";
  static constexpr const char* minimum_fill = "2";
  bool set_ = false;
};

/// Adds the ascending columns of row `row` to the ascending `columns`, by way of `buffer`.
void unite(const SparseMatrix& matrix, int row, std::vector<int>& columns, std::vector<int>& buffer) {
  const int* begin = matrix.innerIndexPtr() + matrix.outerIndexPtr()[row];
  const int* end = matrix.innerIndexPtr() + matrix.outerIndexPtr()[row + 1];
  buffer.clear();
  std::set_union(columns.begin(), columns.end(), begin, end, std::back_inserter(buffer));
  columns.swap(buffer);
}

} // namespace

template <int dim>
void LinearSystem<dim>::collect_pattern() {
  const int size = disc_.unknowns();
  std::vector<std::vector<int>> tangent_columns;
  if (!operators_.nonlinear_cells.empty()) tangent_columns.resize(size);
  for (const auto& cell : operators_.nonlinear_cells) {
    const auto unknowns = cell_unknowns(disc_, cell);
    for (const int row : unknowns)
      tangent_columns[row].insert(tangent_columns[row].end(), unknowns.begin(), unknowns.end());
  }
  const auto terms = constant_terms(operators_, {});
  row_begin_.assign(1, 0);
  row_begin_.reserve(static_cast<std::size_t>(size) + 1);
  columns_.clear();
  std::vector<int> columns, buffer;
  for (int row = 0; row < size; ++row) {
    columns.clear();
    for (const auto& [matrix, factor] : terms) unite(*matrix, row, columns, buffer);
    if (added_stiffness_) unite(*added_stiffness_, row, columns, buffer);
    if (!tangent_columns.empty() && !tangent_columns[row].empty()) {
      columns.insert(columns.end(), tangent_columns[row].begin(), tangent_columns[row].end());
      std::sort(columns.begin(), columns.end());
      columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
    }
    // A diagonal entry for every unknown.
    const auto diagonal = std::lower_bound(columns.begin(), columns.end(), row);
    if (operators_.ownership.owner[row] == operators_.rank && (diagonal == columns.end() || *diagonal != row))
      columns.insert(diagonal, row);
    columns_.insert(columns_.end(), columns.begin(), columns.end());
    row_begin_.push_back(static_cast<int>(columns_.size()));
  }
}

template <int dim>
int LinearSystem<dim>::place_of(int row, int column) const {
  const auto begin = columns_.begin() + row_begin_[row], end = columns_.begin() + row_begin_[row + 1];
  return static_cast<int>(std::lower_bound(begin, end, column) - columns_.begin());
}

template <int dim>
LinearSystem<dim>::LinearSystem(const Discretisation<dim>& disc, const Operators<dim>& operators,
                                int factor_every, PhaseTimer& timer, bool iterates)
    : disc_(disc),
      operators_(operators),
      timer_(timer),
      factor_every_(factor_every),
      iterates_(factor_every > 1 || operators.has_nonlinear_solid || iterates) {
  const auto scope = timer_.measure("assemble");
  prepare();
}

template <int dim>
void LinearSystem<dim>::prepare() {
  const auto& disc = disc_;
  const auto& operators = operators_;
  const auto& index = operators.ownership.petsc_index;
  const int rank = operators.rank;
  const PetscInt own = operators.ownership.first[rank + 1] - operators.ownership.first[rank];
  const PetscInt size = disc.unknowns();

  for (auto* places : {&flow_places_, &tangent_places_, &identity_places_}) places->clear();
  holder_entries_.clear();
  holder_place_ = factored_at_ = -1;
  factors_.reset();
  matrix_ = {};
  for (auto* vector : {&rhs_, &solution_, &gathered_, &residual_}) *vector = {};
  gather_ = {};
  solver_ = {};
  blocks_.reset();
  split_ = scaled_ = false;
  row_scale_ = {};
  reduced_.reset();
  collect_pattern();
  for (const auto& cell : operators.nonlinear_cells) {
    const auto unknowns = cell_unknowns(disc, cell);
    for (const int column : unknowns)
      for (const int row : unknowns) tangent_places_.push_back(place_of(row, column));
  }
  if (disc.reduced && disc.reduced->basis.cols() > 0) {
    reduced_.emplace(disc.reduced->basis, row_begin_, columns_, operators.comm);
    if (!disc.joined.empty() && operators.ownership.owner[disc.joined.front()] == rank) {
      holder_place_ = 0;
      holder_entries_.assign(1, 0.0);
    }
    return;
  }
  // Every entry once: PETSc sorts and adds up what it is given, which costs more than assembling it.
  std::vector<PetscInt> rows(columns_.size()), columns(columns_.size());
  const int first = disc.joined.empty() ? -1 : disc.joined.front();
  std::vector<int> stands_for(size); // by unknown: itself, or the first of the joined
  std::iota(stands_for.begin(), stands_for.end(), 0);
  for (const int unknown : disc.joined) stands_for[unknown] = first;
  for (int row = 0; row < size; ++row)
    for (int k = row_begin_[row]; k < row_begin_[row + 1]; ++k) {
      // Of constrained rows the owner's diagonal alone stays; the others get a negative index, which PETSc
      // skips.
      const bool by_identity = disc.is_constrained[row] && stands_for[row] != first;
      const bool kept = !by_identity || (columns_[k] == row && operators.ownership.owner[row] == rank);
      rows[k] = kept ? index[stands_for[row]] : -1;
      columns[k] = index[stands_for[columns_[k]]];
      if (kept && by_identity) identity_places_.push_back(k);
    }
  for (const int unknown : disc.joined) {
    if (operators.ownership.owner[unknown] != rank) continue;
    const auto add = [&](int column, double value) {
      rows.push_back(index[unknown]);
      columns.push_back(index[column]);
      holder_entries_.push_back(value);
    };
    if (unknown == first) {
      holder_place_ = static_cast<int>(holder_entries_.size());
      add(first, 0.0);
    } else {
      add(unknown, 1.0);
      add(first, -1.0);
    }
  }

  check_petsc(MatCreate(operators.comm, matrix_.out()), "creating the system matrix");
  check_petsc(MatSetSizes(matrix_.get(), own, own, size, size), "sizing the system matrix");
  check_petsc(MatSetType(matrix_.get(), MATAIJ), "typing the system matrix");
  check_petsc(MatSetOptionsPrefix(matrix_.get(), "fsi_"),
              "naming the system matrix"); // the factors inherit it
  check_petsc(MatSetPreallocationCOO(matrix_.get(), static_cast<PetscCount>(rows.size()), rows.data(),
                                     columns.data()),
              "preallocating the system matrix");
  check_petsc(MatCreateVecs(matrix_.get(), solution_.out(), rhs_.out()), "creating vectors");
  check_petsc(VecDuplicate(rhs_.get(), residual_.out()), "creating vectors");
  check_petsc(VecScatterCreateToAll(solution_.get(), gather_.out(), gathered_.out()), "creating the gather");
}

template <int dim>
bool LinearSystem<dim>::wants_blocks() const {
  std::array<char, 16> stated{};
  PetscBool is_stated = PETSC_FALSE;
  check_petsc(
      PetscOptionsGetString(nullptr, nullptr, "-fsi_solver", stated.data(), stated.size(), &is_stated),
      "reading -fsi_ options");
  const std::string solver = is_stated ? stated.data() : "";
  if (is_stated && solver != "direct" && solver != "blocks")
    throw InputError("there is no such solver", solver, "direct or blocks", "option -fsi_solver");
  if (is_stated) return solver == "blocks";
  return dim == 3 && disc_.unknowns() > largest_factored && factors_->mass > 0;
}

template <int dim>
void LinearSystem<dim>::set_row_scale() {
  // So that a residual of continuity counts as the velocity that would mend it does in the rows of momentum:
  // their ratio is that of density * size / time step, a thousand and more.
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(4); // mass and its rows, |divergence| and its rows
  for (int node = 0; node < disc_.vertex_nodes(); ++node) {
    const int velocity = disc_.velocity_unknown(node, 0), pressure = disc_.pressure_unknown(node);
    if (operators_.ownership.owner[velocity] == operators_.rank) sums[1] += 1;
    if (operators_.ownership.owner[pressure] == operators_.rank) sums[3] += 1;
    sums[0] += factors_->mass * operators_.mass.coeff(velocity, velocity);
    for (SparseMatrix::InnerIterator entry(operators_.physical, pressure); entry; ++entry)
      sums[2] += std::abs(entry.value());
  }
  sum_over_ranks(operators_.comm, sums);
  const double scale = sums[0] > 0 && sums[2] > 0 ? (sums[0] / sums[1]) / (sums[2] / sums[3]) : 1.0;
  Eigen::VectorXd rows = Eigen::VectorXd::Ones(disc_.unknowns());
  for (int node = 0; node < disc_.vertex_nodes(); ++node)
    if (!disc_.is_constrained[disc_.pressure_unknown(node)]) rows[disc_.pressure_unknown(node)] = scale;
  check_petsc(VecDuplicate(rhs_.get(), row_scale_.out()), "creating vectors");
  fill(row_scale_.get(), rows);
}

template <int dim>
void LinearSystem<dim>::make_solver() {
  if (wants_blocks()) {
    blocks_ = unknown_blocks(disc_, operators_);
    set_row_scale();
  }
  check_petsc(KSPCreate(operators_.comm, solver_.out()), "creating the solver");
  check_petsc(KSPSetOptionsPrefix(solver_.get(), "fsi_"), "naming the solver");
  check_petsc(KSPSetTolerances(solver_.get(), linear_tolerance, 1e-300, 1e10, most_corrections),
              "setting tolerances");
  if (blocks_) {
    check_petsc(KSPSetType(solver_.get(), KSPFGMRES), "choosing the solver");
    check_petsc(KSPGMRESSetRestart(solver_.get(), restart_of_blocks), "choosing the solver");
  } else {
    check_petsc(KSPSetType(solver_.get(), iterates_ ? KSPGMRES : KSPPREONLY), "choosing the solver");
    PC preconditioner = nullptr;
    check_petsc(KSPGetPC(solver_.get(), &preconditioner), "getting the preconditioner");
    check_petsc(PCSetType(preconditioner, PCLU), "choosing LU");
    check_petsc(PCFactorSetMatSolverType(preconditioner, MATSOLVERMUMPS), "choosing MUMPS");
  }
  check_petsc(KSPSetOperators(solver_.get(), matrix_.get(), matrix_.get()), "setting the operator");
  check_petsc(KSPSetFromOptions(solver_.get()), "reading -fsi_ options");
  check_petsc(KSPGetTolerances(solver_.get(), &stated_tolerance_, nullptr, nullptr, &most_iterations_),
              "asking the solver");
}

template <int dim>
void LinearSystem<dim>::add_constant(const SparseMatrix& matrix, double factor) {
  for (int row = 0; row < disc_.unknowns(); ++row) {
    int place = row_begin_[row];
    for (int k = matrix.outerIndexPtr()[row]; k < matrix.outerIndexPtr()[row + 1]; ++k) {
      const int column = matrix.innerIndexPtr()[k];
      while (columns_[place] < column) ++place; // the pattern holds every column
      constant_[place] += factor * matrix.valuePtr()[k];
    }
  }
}

template <int dim>
void LinearSystem<dim>::sum_constant_terms(const SystemFactors& factors) {
  constant_.assign(columns_.size(), 0.0);
  for (const auto& [matrix, factor] : constant_terms(operators_, factors)) add_constant(*matrix, factor);
  if (added_stiffness_) add_constant(*added_stiffness_, factors.stiffness);
}

template <int dim>
void LinearSystem<dim>::assemble(const SystemFactors& factors, const Eigen::VectorXd* b) {
  const auto scope = timer_.measure("assemble");
  if (stale_ || !(factors_ == factors)) {
    sum_constant_terms(factors);
    if (!(factors_ == factors)) factored_at_ = -1;
    factors_ = factors;
    stale_ = false;
    if (holder_place_ >= 0) holder_entries_[holder_place_] = factors.holder;
  }
  without_tangents_ = constant_;
  if (b && has_convection(disc_)) {
    if (flow_places_.empty())
      visit_flow_dependent(disc_, operators_, *b, [&](int row, int column, double) {
        flow_places_.push_back(place_of(row, column));
      });
    auto place = flow_places_.begin();
    visit_flow_dependent(disc_, operators_, *b,
                         [&](int, int, double value) { without_tangents_[*place++] += value; });
  }
  if (!operators_.has_nonlinear_solid) write(without_tangents_);
}

template <int dim>
void LinearSystem<dim>::write(std::vector<double>& values) {
  if (reduced_) {
    values_ = values;
    return;
  }
  for (const int place : identity_places_) values[place] = 1.0;
  values.resize(columns_.size());
  values.insert(values.end(), holder_entries_.begin(), holder_entries_.end());
  check_petsc(MatSetValuesCOO(matrix_.get(), values.data(), INSERT_VALUES), "filling the system matrix");
  scaled_ = false;
}

template <int dim>
bool LinearSystem<dim>::has_places_for(const SparseMatrix& matrix) const {
  for (int row = 0; row < disc_.unknowns(); ++row) {
    int place = row_begin_[row];
    for (int k = matrix.outerIndexPtr()[row]; k < matrix.outerIndexPtr()[row + 1]; ++k) {
      while (place < row_begin_[row + 1] && columns_[place] < matrix.innerIndexPtr()[k]) ++place;
      if (place == row_begin_[row + 1] || columns_[place] != matrix.innerIndexPtr()[k]) return false;
    }
  }
  return true;
}

template <int dim>
bool LinearSystem<dim>::all_have(bool on_this_rank) const {
  int fits = on_this_rank ? 1 : 0;
  check_petsc(
      static_cast<PetscErrorCode>(MPI_Allreduce(MPI_IN_PLACE, &fits, 1, MPI_INT, MPI_LAND, operators_.comm)),
      "comparing patterns");
  return fits != 0;
}

template <int dim>
void LinearSystem<dim>::refresh() {
  renew_constants();
  factored_at_ = -1;
}

template <int dim>
void LinearSystem<dim>::renew_constants() {
  bool fits = !added_stiffness_ || has_places_for(*added_stiffness_);
  for (const auto& [matrix, factor] : constant_terms(operators_, {})) fits = fits && has_places_for(*matrix);
  if (!all_have(fits))
    throw NumericsError("new operators have entries that the system matrix was not made for",
                        "a refresh of the linear system", "a new linear system for every new cut");
  stale_ = true;
}

template <int dim>
void LinearSystem<dim>::add_stiffness(const SparseMatrix* added) {
  added_stiffness_ = added;
  if (!all_have(!added || has_places_for(*added))) {
    const auto scope = timer_.measure("assemble");
    prepare();
  }
  renew_constants();
}

template <int dim>
void LinearSystem<dim>::replace_tangents(
    const std::vector<typename CellResponse<dim>::Derivatives>& tangents) {
  if (!operators_.has_nonlinear_solid) return;
  const auto scope = timer_.measure("assemble");
  std::vector<double> values = without_tangents_;
  auto place = tangent_places_.begin();
  for (const auto& tangent : tangents)
    for (Eigen::Index k = 0; k < tangent.size(); ++k) values[*place++] += tangent.data()[k];
  write(values);
}

template <int dim>
void LinearSystem<dim>::fill(Vec vector, const Eigen::VectorXd& values) {
  const auto& index = operators_.ownership.petsc_index;
  const int first = operators_.ownership.first[operators_.rank];
  double* entries = nullptr;
  check_petsc(VecGetArray(vector, &entries), "filling a vector");
  for (int unknown = 0; unknown < disc_.unknowns(); ++unknown)
    if (operators_.ownership.owner[unknown] == operators_.rank)
      entries[index[unknown] - first] = values[unknown];
  check_petsc(VecRestoreArray(vector, &entries), "filling a vector");
}

template <int dim>
void LinearSystem<dim>::check_residual(int step) {
  // What the solver's own measure of convergence does not see: preonly never looks, and a preconditioner that
  // hides a part of the system hides its residual as well.
  double right_side = 0, left_over = 0;
  check_petsc(MatMult(matrix_.get(), solution_.get(), residual_.get()), "checking the solution");
  check_petsc(VecAYPX(residual_.get(), -1.0, rhs_.get()), "checking the solution");
  check_petsc(VecNorm(residual_.get(), NORM_2, &left_over), "checking the solution");
  check_petsc(VecNorm(rhs_.get(), NORM_2, &right_side), "checking the solution");
  if (left_over <= largest_residual * right_side || !std::isfinite(left_over))
    return; // solve() looks for nan
  char seen[64];
  std::snprintf(seen, sizeof seen, "a residual of %.2g of the right-hand side", left_over / right_side);
  throw NumericsError("the linear solver's answer does not solve the system",
                      "step " + std::to_string(step) + ": " + seen,
                      "the default solver, without -fsi_ options, or a tighter -fsi_ksp_rtol");
}

template <int dim>
Eigen::VectorXd LinearSystem<dim>::solve(const Eigen::VectorXd& rhs, int step, int iteration,
                                         const Eigen::VectorXd* guess, double tolerance) {
  if (reduced_) {
    const auto scope = timer_.measure("solve");
    Eigen::VectorXd x = reduced_->solve(values_, rhs, holder_place_ >= 0 ? disc_.joined.front() : -1,
                                        holder_place_ >= 0 ? holder_entries_.front() : 0.0);
    if (!x.allFinite())
      throw NumericsError("the projected system has no finite solution", "step " + std::to_string(step),
                          "a smaller time step, or a model with more modes");
    return x;
  }
  const auto& index = operators_.ownership.petsc_index;
  if (!solver_.get()) make_solver();
  if (blocks_) tolerance = std::max(tolerance, block_tolerance);
  fill(rhs_.get(), rhs);
  if (blocks_) {
    check_petsc(VecPointwiseMult(rhs_.get(), rhs_.get(), row_scale_.get()), "scaling the system");
    if (!scaled_)
      check_petsc(MatDiagonalScale(matrix_.get(), row_scale_.get(), nullptr), "scaling the system");
    scaled_ = true;
  }
  bool reuse = false;
  {
    const auto scope = timer_.measure("factor");
    std::optional<QuickOrdering> ordering;
    if (disc_.interface_moves && factored_at_ < 0) ordering.emplace();
    reuse = factored_at_ >= 0 && (iteration > 1 || ((step - 1) % factor_every_ != 0 && !worn_));
    check_petsc(KSPSetReusePreconditioner(solver_.get(), reuse ? PETSC_TRUE : PETSC_FALSE),
                "reusing the factors");
    // Without new operators KSPSetUp would leave the factorisation to KSPSolve, and its time to phase
    // "solve".
    check_petsc(KSPSetOperators(solver_.get(), matrix_.get(), matrix_.get()), "setting the operator");
    if (blocks_ && !split_) precondition_by_blocks(solver_.get(), *blocks_);
    split_ = blocks_.has_value();
    check_petsc(KSPSetUp(solver_.get()), "factoring the system");
    if (!reuse) factored_at_ = step;
    check_petsc(
        KSPSetTolerances(
            solver_.get(), stated_tolerance_ != linear_tolerance ? stated_tolerance_ : tolerance,
            PETSC_DEFAULT, PETSC_DEFAULT,
            std::min(most_iterations_, reuse && !blocks_ ? most_corrections_of_old : most_corrections)),
        "setting tolerances");
  }
  const auto scope = timer_.measure("solve");
  const bool guessed = guess && (reuse || blocks_);
  check_petsc(KSPSetInitialGuessNonzero(solver_.get(), guessed ? PETSC_TRUE : PETSC_FALSE),
              "setting the guess");
  if (guessed) fill(solution_.get(), *guess);
  check_petsc(KSPSolve(solver_.get(), rhs_.get(), solution_.get()), "solving the system");
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  check_petsc(KSPGetConvergedReason(solver_.get(), &reason), "asking the solver");
  PetscInt corrections = 0;
  check_petsc(KSPGetIterationNumber(solver_.get(), &corrections), "asking the solver");
  iterations_ = static_cast<int>(corrections);
  if (!reuse)
    worn_ = false;
  else if (iteration == 1) // later ones of Newton say nothing of the next step
    worn_ = reason < 0 || corrections > worthwhile_corrections;
  if (reason < 0 && reuse) {
    // Flow or solids are too far from where the factors were made. What GMRES left is no guess.
    if (iteration == 1) factored_at_ = step;
    worn_ = false;
    check_petsc(KSPSetInitialGuessNonzero(solver_.get(), PETSC_FALSE), "dropping the guess");
    check_petsc(KSPSetReusePreconditioner(solver_.get(), PETSC_FALSE), "factoring anew");
    check_petsc(KSPSetOperators(solver_.get(), matrix_.get(), matrix_.get()), "setting the operator");
    check_petsc(KSPSolve(solver_.get(), rhs_.get(), solution_.get()), "solving the system");
    check_petsc(KSPGetConvergedReason(solver_.get(), &reason), "asking the solver");
  }
  check_residual(step);
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
        blocks_ ? "a smaller time step, or -fsi_solver direct"
                : "a smaller time step (time.steps_per_period), a smaller stroke, or -fsi_ solver options");
  return x;
}

template class LinearSystem<2>;

template class LinearSystem<3>;

} // namespace undula::fom
