#include "fom/thin_gap/band_matrix.hpp"

#include <lapacke.h>

#include <algorithm>

namespace undula::fom {

BandMatrix::BandMatrix(int size, int reach)
    : size_(size),
      reach_(reach),
      height_(3 * reach + 1),
      entries_(static_cast<std::size_t>(size) * height_),
      pivots_(size) {}

void BandMatrix::set_zero() { std::fill(entries_.begin(), entries_.end(), 0.0); }

void BandMatrix::clear_row(int row) {
  for (int column = std::max(0, row - reach_); column <= std::min(size_ - 1, row + reach_); ++column)
    (*this)(row, column) = 0;
}

void BandMatrix::add_row_to(int row, Eigen::VectorXd& sum) const {
  for (int column = std::max(0, row - reach_); column <= std::min(size_ - 1, row + reach_); ++column)
    sum[column] += entries_[place(row, column)];
}

bool BandMatrix::factor() {
  return LAPACKE_dgbtrf_work(LAPACK_COL_MAJOR, size_, size_, reach_, reach_, entries_.data(), height_,
                             pivots_.data()) == 0;
}

void BandMatrix::solve(Eigen::VectorXd& right_side) const {
  LAPACKE_dgbtrs_work(LAPACK_COL_MAJOR, 'N', size_, reach_, reach_, 1, entries_.data(), height_,
                      pivots_.data(), right_side.data(), size_);
}

} // namespace undula::fom
