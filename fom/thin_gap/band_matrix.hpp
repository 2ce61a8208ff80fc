// Band matrices, solved by LAPACK.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace undula::fom {

/// Square matrix with `reach` diagonals on either side of the main one, in LAPACK's band storage with room
/// for the fill-in of pivoting.
class BandMatrix {
public:
  BandMatrix(int size, int reach);
  int size() const { return size_; }
  void set_zero();
  /// Entry (row, column), |row - column| <= reach.
  double& operator()(int row, int column) { return entries_[place(row, column)]; }
  void clear_row(int row);
  /// Adds a row to a dense vector of all columns.
  void add_row_to(int row, Eigen::VectorXd& sum) const;
  /// LU with partial pivoting, in place. False if a pivot is zero.
  [[nodiscard]] bool factor();
  /// After factor(): replaces `right_side` by the solution.
  void solve(Eigen::VectorXd& right_side) const;

private:
  std::size_t place(int row, int column) const {
    return static_cast<std::size_t>(column) * height_ + 2 * reach_ + row - column;
  }

  int size_, reach_, height_;
  std::vector<double> entries_;
  std::vector<int> pivots_;
};

} // namespace undula::fom
