// Sparse matrices in natural numbering. With several ranks each holds its share; the operator is their sum.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

namespace undula {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// Sums repeated entries into a matrix with `size` rows and columns.
inline SparseMatrix compress(int size, const Triplets& triplets) {
  SparseMatrix matrix(size, size);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

} // namespace undula
