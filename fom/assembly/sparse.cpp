#include "fom/assembly/sparse.hpp"

#include <algorithm>

namespace undula::fom {

SparseMatrix compress(int size, const Triplets& triplets) {
  // Entries by row, in their order; then row by row through an array of places by column. A step with a new
  // cut does this for every operator, and Eigen's setFromTriplets sorts through two transpositions of the
  // whole.
  std::vector<int> begin(static_cast<std::size_t>(size) + 1, 0);
  for (const auto& entry : triplets) ++begin[entry.row() + 1];
  for (int row = 0; row < size; ++row) begin[row + 1] += begin[row];
  std::vector<std::pair<int, double>> by_row(triplets.size());
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (const auto& entry : triplets) by_row[next[entry.row()]++] = {entry.col(), entry.value()};

  std::vector<double> sum(size, 0.0);
  std::vector<int> seen_in(size, -1), columns;
  std::vector<int> outer(1, 0), inner;
  std::vector<double> values;
  outer.reserve(static_cast<std::size_t>(size) + 1);
  for (int row = 0; row < size; ++row) {
    columns.clear();
    for (int k = begin[row]; k < begin[row + 1]; ++k) {
      const auto& [column, value] = by_row[k];
      if (seen_in[column] != row) {
        seen_in[column] = row;
        sum[column] = value;
        columns.push_back(column);
      } else {
        sum[column] += value;
      }
    }
    std::sort(columns.begin(), columns.end());
    inner.insert(inner.end(), columns.begin(), columns.end());
    for (const int column : columns) values.push_back(sum[column]);
    outer.push_back(static_cast<int>(inner.size()));
  }
  return Eigen::Map<const SparseMatrix>(size, size, static_cast<Eigen::Index>(values.size()), outer.data(),
                                        inner.data(), values.data());
}

bool RepeatedSum::fits(int size, const Triplets& triplets, const SparseMatrix& matrix) const {
  if (matrix.rows() != size || matrix.nonZeros() != non_zeros_ || triplets.size() != entries_.size())
    return false;
  for (std::size_t k = 0; k < triplets.size(); ++k)
    if (triplets[k].row() != entries_[k].first || triplets[k].col() != entries_[k].second) return false;
  return true;
}

void RepeatedSum::sum(int size, const Triplets& triplets, SparseMatrix& matrix) {
  if (fits(size, triplets, matrix)) {
    double* values = matrix.valuePtr();
    for (std::size_t k = 0; k < triplets.size(); ++k) {
      double& value = values[places_[k]];
      value = first_[k] ? triplets[k].value() : value + triplets[k].value();
    }
    return;
  }
  matrix = compress(size, triplets);
  non_zeros_ = matrix.nonZeros();
  entries_.clear();
  places_.clear();
  first_.clear();
  std::vector<char> met(static_cast<std::size_t>(matrix.nonZeros()), 0);
  for (const auto& entry : triplets) {
    const int* begin = matrix.innerIndexPtr() + matrix.outerIndexPtr()[entry.row()];
    const int* end = matrix.innerIndexPtr() + matrix.outerIndexPtr()[entry.row() + 1];
    const auto place = std::lower_bound(begin, end, entry.col()) - matrix.innerIndexPtr();
    entries_.emplace_back(entry.row(), entry.col());
    places_.push_back(static_cast<int>(place));
    first_.push_back(!met[static_cast<std::size_t>(place)]);
    met[static_cast<std::size_t>(place)] = 1;
  }
}

} // namespace undula::fom
