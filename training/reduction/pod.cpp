#include "training/reduction/pod.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>
#include <vector>

#include "fom/system/handles.hpp"
#include "rom/base/error.hpp"
#include "training/reduction/dense_eigen.hpp"
#include "training/training.hpp"

namespace undula::training {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Inner products and norms of distributed columns; each rank passes its rows.
class InnerProduct {
public:
  explicit InnerProduct(Mat matrix) : matrix_(matrix), comm_(PetscObjectComm(PetscObject(matrix))) {
    check_petsc(MatGetOwnershipRange(matrix, &begin_, &end_), "MatGetOwnershipRange");
    PetscInt columns = 0;
    check_petsc(MatGetSize(matrix, &rows_, &columns), "MatGetSize");
  }
  MPI_Comm comm() const { return comm_; }
  Index local_rows() const { return end_ - begin_; }
  Index first_row() const { return begin_; }

  /// W x, this rank's rows.
  MatrixXd apply(const MatrixXd& x) const {
    MatrixXd copy = x; // PETSc wants memory it may write to
    PetscMat in;
    check_petsc(MatCreateDense(comm_, end_ - begin_, PETSC_DECIDE, rows_, static_cast<PetscInt>(x.cols()),
                               copy.data(), in.out()),
                "wrapping the snapshots");
    PetscMat out;
    check_petsc(MatMatMult(matrix_, in.get(), MAT_INITIAL_MATRIX, PETSC_DEFAULT, out.out()), "MatMatMult");
    const PetscScalar* values = nullptr;
    PetscInt stride = 0;
    check_petsc(MatDenseGetLDA(out.get(), &stride), "MatDenseGetLDA");
    check_petsc(MatDenseGetArrayRead(out.get(), &values), "MatDenseGetArrayRead");
    MatrixXd result = Eigen::Map<const MatrixXd, 0, Eigen::OuterStride<>>(values, x.rows(), x.cols(),
                                                                          Eigen::OuterStride<>(stride));
    check_petsc(MatDenseRestoreArrayRead(out.get(), &values), "MatDenseRestoreArrayRead");
    return result;
  }

  /// a^T b over all rows; the same on every rank.
  MatrixXd dot(const MatrixXd& a, const MatrixXd& b) const {
    MatrixXd product = a.transpose() * b;
    MPI_Allreduce(MPI_IN_PLACE, product.data(), static_cast<int>(product.size()), MPI_DOUBLE, MPI_SUM, comm_);
    return product;
  }

private:
  Mat matrix_;
  MPI_Comm comm_;
  PetscInt begin_ = 0, end_ = 0, rows_ = 0;
};

std::string scientific(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// Decided on reduced values, so that all ranks throw together.
void check_input(const MatrixXd& snapshots, const InnerProduct& product, const PodOptions& options) {
  int flags[3] = {snapshots.rows() != product.local_rows(), !snapshots.allFinite(), snapshots.cols() == 0};
  MPI_Allreduce(MPI_IN_PLACE, flags, 3, MPI_INT, MPI_MAX, product.comm());
  if (flags[0])
    throw InputError("snapshots do not fit the inner product", std::to_string(snapshots.rows()) + " rows",
                     "as many rows as the matrix has on this rank: " + std::to_string(product.local_rows()),
                     "pod");
  if (flags[2]) throw InputError("nothing to decompose", "0 snapshots", "at least one", "pod");
  if (!(options.energy_tolerance >= 0 && options.energy_tolerance < 1))
    throw InputError("energy tolerance of the POD out of range", scientific(options.energy_tolerance),
                     "[0, 1)", "training.energy_tolerance");
  if (flags[1])
    throw NumericsError("snapshots are not finite", "POD",
                        "look for the run that diverged; leave its record out");
}

/// Makes the columns of `block` W-orthonormal: Cholesky QR, twice. They must be nearly so.
void orthonormalise(const InnerProduct& product, MatrixXd& block) {
  for (int pass = 0; pass < 2; ++pass) {
    const Eigen::LLT<MatrixXd> factor(product.dot(block, product.apply(block)));
    if (factor.info() != Eigen::Success)
      throw NumericsError("POD modes are linearly dependent", "POD",
                          "check that the inner product is semidefinite");
    factor.matrixU().solveInPlace<Eigen::OnTheRight>(block);
  }
}

void remove_components(const InnerProduct& product, const MatrixXd& weighted_basis, const MatrixXd& basis,
                       MatrixXd& block) {
  if (basis.cols() > 0) block -= basis * product.dot(weighted_basis, block);
}

/// W-orthonormal basis V of the span of the snapshots down to a residual energy of `floor`.
///
/// The eigenvalues of X^T W X are squares, so one pass resolves singular values down to 1e-8 of the largest
/// only. Therefore each pass takes the well-resolved part (sigma > 1e-5 sigma_1), removes it from the
/// snapshots and starts again on the rest; the rest of a pass is again resolved relative to its own largest
/// value.
struct SpanBasis {
  MatrixXd basis;      ///< n_local x k
  MatrixXd weighted;   ///< W V
  double energy = 0;   ///< of all snapshots
  double residual = 0; ///< energy outside of the span
};

SpanBasis span_of(const MatrixXd& snapshots, const InnerProduct& product, const PodOptions& options) {
  const Index m = snapshots.cols();
  SpanBasis span{MatrixXd(snapshots.rows(), 0), MatrixXd(snapshots.rows(), 0)};
  const double round_off = 1e-28;
  const double relative_floor = std::max(round_off, 1e-6 * options.energy_tolerance);
  MatrixXd rest = snapshots;
  while (true) {
    const MatrixXd gram = product.dot(rest, product.apply(rest));
    span.residual = std::max(0.0, gram.trace());
    if (span.basis.cols() == 0) span.energy = gram.trace();
    if (!(span.energy > 0))
      throw NumericsError("snapshots have no energy in the inner product",
                          "POD: energy " + scientific(span.energy),
                          "check that the field moves at all and that the inner product is positive");
    const bool enough = options.max_modes > 0 && span.basis.cols() >= options.max_modes;
    if (span.residual <= relative_floor * span.energy || enough || span.basis.cols() >= m) return span;

    const auto eigen = symmetric_eigenpairs(gram);
    const double largest = eigen.values[0];
    if (eigen.values[m - 1] < -1e-10 * std::max(largest, round_off * span.energy) && span.basis.cols() == 0)
      throw NumericsError(
          "the inner product of the POD is not positive semidefinite",
          "eigenvalue " + scientific(eigen.values[m - 1]) + " beside " + scientific(largest),
          "use the mass or energy matrix, symmetric and without penalty terms of negative sign");
    const auto is_resolved = [&](double value) { return value > 1e-10 * largest; };
    const Index found = std::min<Index>(m - span.basis.cols(),
                                        std::count_if(eigen.values.begin(), eigen.values.end(), is_resolved));
    if (!(largest > 0) || found == 0) return span;
    const VectorXd scale = eigen.values.head(found).cwiseSqrt().cwiseInverse();
    MatrixXd block = rest * (eigen.vectors.leftCols(found) * scale.asDiagonal());
    for (int pass = 0; pass < 2; ++pass) {
      remove_components(product, span.weighted, span.basis, block);
      orthonormalise(product, block);
    }
    const MatrixXd weighted_block = product.apply(block);
    for (int pass = 0; pass < 2; ++pass) remove_components(product, weighted_block, block, rest);
    const Index before = span.basis.cols();
    span.basis.conservativeResize(Eigen::NoChange, before + found);
    span.weighted.conservativeResize(Eigen::NoChange, before + found);
    span.basis.rightCols(found) = block;
    span.weighted.rightCols(found) = weighted_block;
  }
}

/// See PodBasis: the sign must depend neither on the order of the snapshots nor on the number of ranks.
void fix_signs(const InnerProduct& product, MatrixXd& modes) {
  const int count = static_cast<int>(modes.cols());
  VectorXd largest = VectorXd::Zero(count);
  if (modes.rows() > 0) largest = modes.cwiseAbs().colwise().maxCoeff().transpose();
  MPI_Allreduce(MPI_IN_PLACE, largest.data(), count, MPI_DOUBLE, MPI_MAX, product.comm());
  // Global row and sign in one integer, so that one minimum finds the first entry and its sign.
  std::vector<std::int64_t> first(count, std::numeric_limits<std::int64_t>::max());
  for (int k = 0; k < count; ++k)
    for (Index i = 0; i < modes.rows(); ++i) {
      if (std::abs(modes(i, k)) < (1 - 1e-6) * largest[k]) continue;
      first[k] = 2 * (product.first_row() + i) + (modes(i, k) < 0);
      break;
    }
  MPI_Allreduce(MPI_IN_PLACE, first.data(), count, MPI_INT64_T, MPI_MIN, product.comm());
  for (int k = 0; k < count; ++k)
    if (first[k] % 2 == 1) modes.col(k) *= -1;
}

} // namespace

PodBasis pod(const MatrixXd& snapshots, Mat inner_product, const PodOptions& options) {
  const InnerProduct product(inner_product);
  check_input(snapshots, product, options);
  const auto span = span_of(snapshots, product, options);
  // Within the span, X = V C + rest with V orthonormal: the small matrix C has the singular values of X, and
  // its decomposition, unlike that of X^T W X, does not square them.
  const auto svd = left_singular_vectors(product.dot(span.weighted, snapshots));

  PodBasis result;
  result.energy = span.energy;
  result.singular_values = svd.values;
  const Index bound =
      options.max_modes > 0 ? std::min<Index>(options.max_modes, svd.values.size()) : svd.values.size();
  // Tails are summed from the smallest value, so that they are not differences of large numbers.
  VectorXd tails(svd.values.size() + 1);
  tails[svd.values.size()] = span.residual;
  for (Index k = svd.values.size() - 1; k >= 0; --k) tails[k] = tails[k + 1] + svd.values[k] * svd.values[k];
  Index kept = 0;
  while (kept < bound && (kept == 0 || tails[kept] > options.energy_tolerance * span.energy)) ++kept;
  result.tail_energy = tails[kept];
  result.captured_energy = 1 - tails[kept] / span.energy;
  result.modes = span.basis * svd.vectors.leftCols(kept);
  fix_signs(product, result.modes);
  return result;
}

PodBasis pod(const MatrixXd& snapshots, const Eigen::SparseMatrix<double>& inner_product,
             const PodOptions& options) {
  Eigen::SparseMatrix<double, Eigen::RowMajor, PetscInt> rows = inner_product;
  rows.makeCompressed();
  PetscMat matrix;
  check_petsc(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, static_cast<PetscInt>(rows.rows()),
                                        static_cast<PetscInt>(rows.cols()), rows.outerIndexPtr(),
                                        rows.innerIndexPtr(), rows.valuePtr(), matrix.out()),
              "wrapping the inner product");
  return pod(snapshots, matrix.get(), options);
}

} // namespace undula::training
