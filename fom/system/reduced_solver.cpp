#include "fom/system/reduced_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rom/base/gmres.hpp"

namespace undula::fom {
namespace {

/// Of the right-hand side: a matrix that is singular but for rounding leaves more.
constexpr double largest_residual = 1e-2;

} // namespace

ReducedSolver::ReducedSolver(const Eigen::MatrixXd& basis, std::span<const int> row_begin,
                             std::span<const int> columns, MPI_Comm comm)
    : basis_(basis), comm_(comm) {
  const int size = static_cast<int>(row_begin.size()) - 1;
  std::vector<int> place(static_cast<std::size_t>(size), -1);
  std::vector<int> needed;
  const auto place_of = [&](int unknown) {
    int& at = place[static_cast<std::size_t>(unknown)];
    if (at < 0) {
      at = static_cast<int>(needed.size());
      needed.push_back(unknown);
    }
    return at;
  };
  columns_.assign(columns.size(), 0);
  for (int row = 0; row < size; ++row) {
    const int first = row_begin[static_cast<std::size_t>(row)],
              last = row_begin[static_cast<std::size_t>(row) + 1];
    if (last - first < 2) continue; // the diagonal alone, that the pattern has of every unknown
    rows_.push_back(row);
    begin_.push_back(first);
    end_.push_back(last);
    place_.push_back(place_of(row));
    for (int k = first; k < last; ++k)
      columns_[static_cast<std::size_t>(k)] = place_of(columns[static_cast<std::size_t>(k)]);
  }
  modes_ = basis(needed, Eigen::all);
}

void ReducedSolver::sum_over_ranks(double* values, Eigen::Index count) const {
  int ranks = 1;
  MPI_Comm_size(comm_, &ranks);
  if (ranks > 1) MPI_Allreduce(MPI_IN_PLACE, values, static_cast<int>(count), MPI_DOUBLE, MPI_SUM, comm_);
}

Eigen::VectorXd ReducedSolver::product(const System& system, const Eigen::VectorXd& y) const {
  const Eigen::VectorXd nodal = modes_ * y;
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(modes_.rows());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    double sum = 0;
    for (int k = begin_[i]; k < end_[i]; ++k)
      sum += system.values[static_cast<std::size_t>(k)] * nodal[columns_[static_cast<std::size_t>(k)]];
    forces[place_[i]] = sum;
  }
  Eigen::VectorXd projected = modes_.transpose() * forces;
  if (system.holder_row >= 0)
    projected +=
        system.holder * basis_.row(system.holder_row).dot(y) * basis_.row(system.holder_row).transpose();
  sum_over_ranks(projected.data(), projected.size());
  return projected;
}

void ReducedSolver::factor(const System& system) {
  const Eigen::Index count = basis_.cols();
  // A few hundred rows at a time, so that they stay in the cache between the sparse and the dense product.
  constexpr std::size_t block = 256;
  Eigen::MatrixXd projected = Eigen::MatrixXd::Zero(count, count);
  RowMajor left(static_cast<Eigen::Index>(block), count), right(static_cast<Eigen::Index>(block), count);
  for (std::size_t first = 0; first < rows_.size(); first += block) {
    const std::size_t last = std::min(first + block, rows_.size());
    const auto rows = static_cast<Eigen::Index>(last - first);
    for (std::size_t i = first; i < last; ++i) {
      const auto at = static_cast<Eigen::Index>(i - first);
      left.row(at) = modes_.row(place_[i]);
      auto sum = right.row(at);
      sum.setZero();
      for (int k = begin_[i]; k < end_[i]; ++k)
        sum += system.values[static_cast<std::size_t>(k)] * modes_.row(columns_[static_cast<std::size_t>(k)]);
    }
    projected.noalias() += left.topRows(rows).transpose() * right.topRows(rows);
  }
  if (system.holder_row >= 0)
    projected.noalias() +=
        system.holder * basis_.row(system.holder_row).transpose() * basis_.row(system.holder_row);
  sum_over_ranks(projected.data(), projected.size());
  factors_.emplace(projected);
  ++factorisations_;
}

bool ReducedSolver::correct(const System& system, const Eigen::VectorXd& forces) {
  constexpr int most = 12;
  constexpr double tolerance = 1e-10; // of the right-hand side
  const Eigen::VectorXd left = forces - product(system, answer_);
  const double wanted = tolerance * forces.norm(), missing = left.norm();
  if (!std::isfinite(missing)) return false;
  if (missing <= wanted) return true;
  Eigen::MatrixXd change;
  const auto apply = [&](const Eigen::MatrixXd& in, Eigen::MatrixXd& out) {
    out = product(system, factors_->solve(in.col(0)));
  };
  const auto result = gmres(apply, left, change, wanted / missing, most);
  if (!(result.relative_residual <= wanted / missing)) return false;
  answer_ += factors_->solve(change.col(0));
  return true;
}

Eigen::VectorXd ReducedSolver::solve(std::span<const double> values, const Eigen::VectorXd& rhs,
                                     int holder_row, double holder) {
  const System system{values, holder_row, holder};
  const Eigen::VectorXd forces = basis_.transpose() * rhs;
  if (!factors_ || !correct(system, forces)) {
    factor(system);
    answer_ = factors_->solve(forces);
    if (!((forces - product(system, answer_)).norm() <= largest_residual * forces.norm()))
      answer_.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return basis_ * answer_;
}

} // namespace undula::fom
