// Sparse matrices in natural numbering. With several ranks each holds its share; the operator is their sum.
#pragma once

#include <Eigen/SparseCore>
#include <utility>
#include <vector>

namespace undula::fom {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// Sums repeated entries, in their order, into a matrix with `size` rows and columns. Entries that sum to
/// zero stay in the pattern.
SparseMatrix compress(int size, const Triplets& triplets);

/// The same again and again: where rows and columns of the triplets are those of the time before, in their
/// order, every value goes straight to its place. The sums are the same bit for bit.
class RepeatedSum {
public:
  void sum(int size, const Triplets& triplets, SparseMatrix& matrix);

private:
  bool fits(int size, const Triplets& triplets, const SparseMatrix& matrix) const;

  std::vector<std::pair<int, int>> entries_; ///< row, column
  std::vector<int> places_;                  ///< of the entries, among the values of the matrix
  Eigen::Index non_zeros_ = -1;              ///< of the matrix that they were found in
  std::vector<char> first_;                  ///< whether an entry is the first at its place
};

} // namespace undula::fom
