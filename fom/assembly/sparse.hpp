// Sparse matrices in natural numbering. With several ranks each holds its share; the operator is their sum.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

namespace undula::fom {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// Sums repeated entries, in their order, into a matrix with `size` rows and columns. Entries that sum to
/// zero stay in the pattern.
SparseMatrix compress(int size, const Triplets& triplets);

} // namespace undula::fom
