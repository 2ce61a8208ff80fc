// Galerkin's projection of the monolithic system on a few modes, and its solution.
#pragma once

#include <mpi.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <optional>
#include <span>
#include <vector>

namespace undula::fom {

class ReducedSolver {
public:
  /// `basis`: see ReducedSpace, has to outlive the solver. The pattern is that of this rank's share in
  /// natural numbering: the columns of row i are columns[row_begin[i]] up to row_begin[i + 1].
  ReducedSolver(const Eigen::MatrixXd& basis, std::span<const int> row_begin, std::span<const int> columns,
                MPI_Comm comm);

  /// V y with V^T A V y = V^T rhs, A with `values` in the places of the pattern and, on the rank that knows
  /// it, `holder` on the diagonal of row `holder_row` (-1: none). A dense LU of the projected matrix serves
  /// as long as GMRES corrects it in a few products, from the answer before: projecting costs about forty of
  /// them. Collective; NaN where the projection is singular, or its answer does not solve it.
  Eigen::VectorXd solve(std::span<const double> values, const Eigen::VectorXd& rhs, int holder_row,
                        double holder);

  /// Projections made so far.
  int factorisations() const { return factorisations_; }

private:
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  /// A, for one solution.
  struct System {
    std::span<const double> values;
    int holder_row;
    double holder;
  };
  void sum_over_ranks(double* values, Eigen::Index count) const;
  Eigen::VectorXd product(const System& system, const Eigen::VectorXd& y) const;
  void factor(const System& system);
  bool correct(const System& system, const Eigen::VectorXd& forces);
  const Eigen::MatrixXd& basis_;
  MPI_Comm comm_;
  std::vector<int> rows_;        ///< with entries off the diagonal
  std::vector<int> begin_, end_; ///< of the entries of those rows
  std::vector<int> columns_;     ///< by entry of the pattern: row of `modes_`
  RowMajor modes_;               ///< rows of the basis that the pattern needs
  std::vector<int> place_;       ///< by row of rows_: its row of `modes_`
  std::optional<Eigen::PartialPivLU<Eigen::MatrixXd>> factors_;
  Eigen::VectorXd answer_; ///< y of the last solution
  int factorisations_ = 0;
};

} // namespace undula::fom
