#include "training/reduction/dense_eigen.hpp"

#include <slepceps.h>
#include <slepcsvd.h>

#include <algorithm>

#include "fom/system/handles.hpp"
#include "rom/base/error.hpp"
#include "training/training.hpp"

namespace undula::training {
namespace {

using SlepcEigenSolver = PetscHandle<EPS, EPSDestroy>;
using SlepcSingularSolver = PetscHandle<SVD, SVDDestroy>;

/// PETSc's view of the values of `matrix`, which must outlive it.
PetscMat view(Eigen::MatrixXd& matrix) {
  PetscMat result;
  check_petsc(MatCreateSeqDense(PETSC_COMM_SELF, static_cast<PetscInt>(matrix.rows()),
                                static_cast<PetscInt>(matrix.cols()), matrix.data(), result.out()),
              "wrapping a dense matrix");
  return result;
}

PetscVec view(Eigen::Ref<Eigen::VectorXd> vector) {
  PetscVec result;
  check_petsc(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, static_cast<PetscInt>(vector.size()), vector.data(),
                                    result.out()),
              "wrapping a vector");
  return result;
}

void check_count(PetscInt found, Eigen::Index wanted, const char* what) {
  if (found >= wanted) return;
  throw NumericsError(std::string(what) + " of a dense matrix did not converge",
                      std::to_string(found) + " of " + std::to_string(wanted) + " found",
                      "check the snapshots for extreme values");
}

} // namespace

DenseEigen symmetric_eigenpairs(Eigen::MatrixXd matrix) {
  const Eigen::Index n = matrix.rows();
  const PetscMat operand = view(matrix);
  SlepcEigenSolver solver;
  check_petsc(EPSCreate(PETSC_COMM_SELF, solver.out()), "EPSCreate");
  check_petsc(EPSSetOperators(solver.get(), operand.get(), nullptr), "EPSSetOperators");
  check_petsc(EPSSetProblemType(solver.get(), EPS_HEP), "EPSSetProblemType");
  check_petsc(EPSSetType(solver.get(), EPSLAPACK), "EPSSetType");
  check_petsc(EPSSetWhichEigenpairs(solver.get(), EPS_LARGEST_REAL), "EPSSetWhichEigenpairs");
  check_petsc(EPSSetDimensions(solver.get(), static_cast<PetscInt>(n), PETSC_DEFAULT, PETSC_DEFAULT),
              "EPSSetDimensions");
  check_petsc(EPSSolve(solver.get()), "EPSSolve");
  PetscInt found = 0;
  check_petsc(EPSGetConverged(solver.get(), &found), "EPSGetConverged");
  check_count(found, n, "the eigenvalue problem");
  DenseEigen result{Eigen::VectorXd(n), Eigen::MatrixXd(n, n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const PetscVec vector = view(result.vectors.col(i));
    check_petsc(EPSGetEigenpair(solver.get(), static_cast<PetscInt>(i), &result.values[i], nullptr,
                                vector.get(), nullptr),
                "EPSGetEigenpair");
  }
  return result;
}

LeftSingular left_singular_vectors(Eigen::MatrixXd matrix) {
  const Eigen::Index count = std::min(matrix.rows(), matrix.cols());
  const PetscMat operand = view(matrix);
  SlepcSingularSolver solver;
  check_petsc(SVDCreate(PETSC_COMM_SELF, solver.out()), "SVDCreate");
  check_petsc(SVDSetOperators(solver.get(), operand.get(), nullptr), "SVDSetOperators");
  check_petsc(SVDSetType(solver.get(), SVDLAPACK), "SVDSetType");
  check_petsc(SVDSetWhichSingularTriplets(solver.get(), SVD_LARGEST), "SVDSetWhichSingularTriplets");
  check_petsc(SVDSetDimensions(solver.get(), static_cast<PetscInt>(count), PETSC_DEFAULT, PETSC_DEFAULT),
              "SVDSetDimensions");
  check_petsc(SVDSolve(solver.get()), "SVDSolve");
  PetscInt found = 0;
  check_petsc(SVDGetConverged(solver.get(), &found), "SVDGetConverged");
  check_count(found, count, "the singular value problem");
  LeftSingular result{Eigen::VectorXd(count), Eigen::MatrixXd(matrix.rows(), count)};
  Eigen::VectorXd right(matrix.cols());
  const PetscVec right_view = view(right);
  for (Eigen::Index i = 0; i < count; ++i) {
    const PetscVec left = view(result.vectors.col(i));
    check_petsc(SVDGetSingularTriplet(solver.get(), static_cast<PetscInt>(i), &result.values[i], left.get(),
                                      right_view.get()),
                "SVDGetSingularTriplet");
  }
  return result;
}

} // namespace undula::training
