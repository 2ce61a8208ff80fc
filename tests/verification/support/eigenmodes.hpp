// Eigenvalues of assembled operators with the constrained unknowns removed.
#pragma once

#include <slepceps.h>

#include <Eigen/SparseLU>
#include <complex>
#include <vector>

#include "fom/system/handles.hpp"
#include "fom/system/operators.hpp"
#include "tests/verification/support/names.hpp"

namespace undula::verification {

/// The unconstrained unknowns of a discretisation, numbered in a row.
struct FreeUnknowns {
  std::vector<int> reduced; ///< by unknown, -1 where constrained
  std::vector<int> natural; ///< by free unknown

  explicit FreeUnknowns(const std::vector<char>& is_constrained) : reduced(is_constrained.size(), -1) {
    for (std::size_t i = 0; i < is_constrained.size(); ++i) {
      if (is_constrained[i]) continue;
      reduced[i] = static_cast<int>(natural.size());
      natural.push_back(static_cast<int>(i));
    }
  }
  int size() const { return static_cast<int>(natural.size()); }

  /// Visits the entries of `matrix` between free unknowns.
  template <class F>
  void visit(const SparseMatrix& matrix, F&& f) const {
    for (int row = 0; row < matrix.outerSize(); ++row)
      for (SparseMatrix::InnerIterator entry(matrix, row); entry; ++entry)
        if (reduced[row] >= 0 && reduced[entry.col()] >= 0)
          f(reduced[row], reduced[entry.col()], entry.value());
  }
  SparseMatrix restrict_to_free(const SparseMatrix& matrix) const {
    Triplets triplets;
    visit(matrix, [&](int row, int column, double value) { triplets.emplace_back(row, column, value); });
    return compress(size(), triplets);
  }
  Eigen::VectorXd extend(const Eigen::VectorXd& values) const {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(reduced.size()));
    for (int i = 0; i < size(); ++i) all[natural[i]] = values[i];
    return all;
  }
};

/// An angular frequency (rad/s) of stiffness v = omega^2 mass v and its mode.
struct VibrationMode {
  double omega = 0;
  Eigen::VectorXd shape; ///< natural numbering
};

/// The `count` smallest, ascending, by SLEPc with shift and invert.
template <int dim>
std::vector<VibrationMode> vibrations(const Discretisation<dim>& disc, const Operators<dim>& operators,
                                      int count) {
  const FreeUnknowns free(disc.is_constrained);
  const auto to_petsc = [&](const SparseMatrix& matrix, PetscMat& out) {
    const SparseMatrix kept = free.restrict_to_free(matrix);
    check_petsc(MatCreateSeqAIJ(PETSC_COMM_SELF, free.size(), free.size(), 30 * dim, nullptr, out.out()),
                "matrix");
    check_petsc(MatSetOption(out.get(), MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE), "matrix option");
    for (int row = 0; row < kept.outerSize(); ++row)
      for (SparseMatrix::InnerIterator entry(kept, row); entry; ++entry)
        check_petsc(
            MatSetValue(out.get(), row, static_cast<PetscInt>(entry.col()), entry.value(), INSERT_VALUES),
            "entry");
    check_petsc(MatAssemblyBegin(out.get(), MAT_FINAL_ASSEMBLY), "assembly");
    check_petsc(MatAssemblyEnd(out.get(), MAT_FINAL_ASSEMBLY), "assembly");
  };
  PetscMat stiffness, mass;
  to_petsc(operators.stiffness, stiffness);
  to_petsc(operators.mass, mass);
  PetscHandle<EPS, EPSDestroy> solver;
  check_petsc(EPSCreate(PETSC_COMM_SELF, solver.out()), "eigensolver");
  check_petsc(EPSSetOperators(solver.get(), stiffness.get(), mass.get()), "operators");
  check_petsc(EPSSetProblemType(solver.get(), EPS_GHEP), "problem type");
  check_petsc(EPSSetWhichEigenpairs(solver.get(), EPS_TARGET_MAGNITUDE), "which");
  check_petsc(EPSSetTarget(solver.get(), 0.0), "target");
  check_petsc(EPSSetDimensions(solver.get(), count, PETSC_DEFAULT, PETSC_DEFAULT), "number of modes");
  check_petsc(EPSSetTolerances(solver.get(), 1e-10, 500), "tolerance");
  ST transform = nullptr;
  check_petsc(EPSGetST(solver.get(), &transform), "transform");
  check_petsc(STSetType(transform, STSINVERT), "shift and invert");
  KSP linear = nullptr;
  PC factor = nullptr;
  check_petsc(STGetKSP(transform, &linear), "linear solver");
  check_petsc(KSPSetType(linear, KSPPREONLY), "direct");
  check_petsc(KSPGetPC(linear, &factor), "preconditioner");
  check_petsc(PCSetType(factor, PCLU), "LU");
  check_petsc(PCFactorSetMatSolverType(factor, MATSOLVERMUMPS), "MUMPS");
  check_petsc(EPSSolve(solver.get()), "eigenvalues");
  PetscInt found = 0;
  check_petsc(EPSGetConverged(solver.get(), &found), "converged");
  if (found < count) throw std::runtime_error("SLEPc found too few eigenvalues");
  PetscVec vector;
  check_petsc(MatCreateVecs(stiffness.get(), vector.out(), nullptr), "vector");
  std::vector<VibrationMode> modes;
  for (int k = 0; k < count; ++k) {
    double real = 0, imaginary = 0;
    check_petsc(EPSGetEigenpair(solver.get(), k, &real, &imaginary, vector.get(), nullptr), "eigenpair");
    Eigen::VectorXd shape(free.size());
    const double* values = nullptr;
    check_petsc(VecGetArrayRead(vector.get(), &values), "reading");
    for (int i = 0; i < free.size(); ++i) shape[i] = values[i];
    check_petsc(VecRestoreArrayRead(vector.get(), &values), "reading");
    modes.push_back({std::sqrt(real), free.extend(shape)});
  }
  return modes;
}

inline VibrationMode first_vibration(const Discretisation<2>& disc, const Operators<2>& operators) {
  return vibrations(disc, operators, 1).front();
}

/// Eigenvalue s (1/s) and vector of the coupled, linear problem (s mass + physical + stabilisation + damping
/// + stiffness / s) x = 0.
struct CoupledMode {
  std::complex<double> s;
  Eigen::VectorXcd x; ///< natural numbering, pressures and velocities; the displacement is x / s
};

/// Newton's method for the nonlinear eigenvalue problem (Unger 1950): x <- T(s)^-1 T'(s) x, s <- s - 1 / (c .
/// x), from a guess of s and of the velocities.
inline CoupledMode coupled_mode(const Discretisation<2>& disc, const Operators<2>& operators,
                                std::complex<double> s, const Eigen::VectorXd& guess) {
  using Complex = std::complex<double>;
  const FreeUnknowns free(disc.is_constrained);
  const SparseMatrix constant = free.restrict_to_free(
      SparseMatrix(SparseMatrix(operators.physical + operators.stabilisation) + operators.damping));
  const SparseMatrix mass = free.restrict_to_free(operators.mass);
  const SparseMatrix stiffness = free.restrict_to_free(operators.stiffness);
  Eigen::VectorXcd x(free.size());
  for (int i = 0; i < free.size(); ++i) x[i] = guess[free.natural[i]];
  x.normalize();
  Eigen::SparseLU<Eigen::SparseMatrix<Complex>> solver;
  for (int iteration = 0; iteration < 15; ++iteration) {
    const Eigen::SparseMatrix<Complex> matrix =
        Eigen::SparseMatrix<Complex>(constant.cast<Complex>()) +
        Eigen::SparseMatrix<Complex>(mass.cast<Complex>() * s) +
        Eigen::SparseMatrix<Complex>(stiffness.cast<Complex>() * (1.0 / s));
    if (iteration == 0) solver.analyzePattern(matrix);
    solver.factorize(matrix);
    if (solver.info() != Eigen::Success)
      throw std::runtime_error("the eigenvalue iteration met a singular matrix");
    // A crude guess is first brought near the mode by inverse iteration about the fixed s.
    Complex step = 0;
    for (int inner = 0; inner < (iteration == 0 ? 6 : 1); ++inner) {
      const Eigen::VectorXcd next =
          solver.solve(mass.cast<Complex>() * x - stiffness.cast<Complex>() * x / (s * s));
      step = x.squaredNorm() / x.dot(next);
      x = next.normalized();
    }
    s -= step;
    if (std::abs(step) < 1e-6 * std::abs(s)) {
      CoupledMode mode{s, Eigen::VectorXcd::Zero(disc.unknowns())};
      for (int i = 0; i < free.size(); ++i) mode.x[free.natural[i]] = x[i];
      return mode;
    }
  }
  throw std::runtime_error("the eigenvalue iteration did not converge");
}

} // namespace undula::verification
