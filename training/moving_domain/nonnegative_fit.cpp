#include "training/moving_domain/nonnegative_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

namespace undula::training {
namespace {

/// The columns in use and the Cholesky factor of their Gram matrix, which grows by a row per column.
class ActiveColumns {
public:
  ActiveColumns(const Eigen::MatrixXd& gram, const Eigen::VectorXd& right) : gram_(gram), right_(right) {}

  const std::vector<Eigen::Index>& columns() const { return columns_; }

  /// False, and nothing happens, where the column depends on the others.
  bool add(Eigen::Index column) {
    const auto count = static_cast<Eigen::Index>(columns_.size());
    if (factor_.rows() < count + 1) factor_.conservativeResize(2 * (count + 1), 2 * (count + 1));
    Eigen::VectorXd row(count);
    for (Eigen::Index i = 0; i < count; ++i) row[i] = gram_(columns_[static_cast<std::size_t>(i)], column);
    factor_.topLeftCorner(count, count).triangularView<Eigen::Lower>().solveInPlace(row);
    const double rest = gram_(column, column) - row.squaredNorm();
    if (rest <= dependent * gram_(column, column)) return false;
    factor_.row(count).head(count) = row.transpose();
    factor_(count, count) = std::sqrt(rest);
    columns_.push_back(column);
    return true;
  }

  void keep(const std::vector<Eigen::Index>& columns) {
    columns_.clear();
    for (const auto column : columns) add(column);
  }

  Eigen::VectorXd solution() const {
    const auto count = static_cast<Eigen::Index>(columns_.size());
    Eigen::VectorXd weights(count);
    for (Eigen::Index i = 0; i < count; ++i) weights[i] = right_[columns_[static_cast<std::size_t>(i)]];
    const auto lower = factor_.topLeftCorner(count, count).triangularView<Eigen::Lower>();
    lower.solveInPlace(weights);
    lower.transpose().solveInPlace(weights);
    return weights;
  }

private:
  static constexpr double dependent = 1e-10;
  const Eigen::MatrixXd& gram_;
  const Eigen::VectorXd& right_;
  std::vector<Eigen::Index> columns_;
  Eigen::MatrixXd factor_;
};

} // namespace

NonnegativeFit nonnegative_fit(const Eigen::MatrixXd& gram, const Eigen::VectorXd& right, double square,
                               double tolerance, int most) {
  NonnegativeFit fit;
  const Eigen::Index count = right.size();
  fit.weights = Eigen::VectorXd::Zero(count);
  if (square == 0) return fit;
  ActiveColumns active(gram, right);
  std::vector<char> useless(static_cast<std::size_t>(count), 0);
  const auto error = [&] {
    const double left = square - 2 * fit.weights.dot(right) + fit.weights.dot(gram * fit.weights);
    return std::sqrt(std::max(left, 0.0) / square);
  };
  while ((fit.error = error()) > tolerance && static_cast<int>(active.columns().size()) < most) {
    const Eigen::VectorXd slope = right - gram * fit.weights;
    Eigen::Index best = -1;
    for (Eigen::Index column = 0; column < count; ++column)
      if (fit.weights[column] == 0 && !useless[static_cast<std::size_t>(column)] && slope[column] > 0 &&
          (best < 0 ||
           slope[column] / std::sqrt(gram(column, column)) > slope[best] / std::sqrt(gram(best, best))))
        best = column;
    if (best < 0) break;
    if (!active.add(best)) {
      useless[static_cast<std::size_t>(best)] = 1;
      continue;
    }
    Eigen::VectorXd wanted = active.solution();
    if (wanted[wanted.size() - 1] <= 0) { // by rounding: it would only leave again
      useless[static_cast<std::size_t>(best)] = 1;
      auto others = active.columns();
      others.pop_back();
      active.keep(others);
      continue;
    }
    while (wanted.minCoeff() <= 0) {
      // As far towards what is wanted as all weights stay positive; what has reached 0 leaves.
      double part = 1;
      for (Eigen::Index i = 0; i < wanted.size(); ++i) {
        const double now = fit.weights[active.columns()[static_cast<std::size_t>(i)]];
        if (wanted[i] <= 0) part = std::min(part, now / (now - wanted[i]));
      }
      std::vector<Eigen::Index> kept;
      for (Eigen::Index i = 0; i < wanted.size(); ++i) {
        const Eigen::Index column = active.columns()[static_cast<std::size_t>(i)];
        double& now = fit.weights[column];
        const bool leaves = wanted[i] <= 0 && now / (now - wanted[i]) <= part * (1 + 1e-12);
        now = leaves ? 0.0 : now + part * (wanted[i] - now);
        if (!leaves) kept.push_back(column);
      }
      active.keep(kept);
      for (const auto column : kept) // one that depends on the others by rounding leaves as well
        if (std::ranges::find(active.columns(), column) == active.columns().end()) fit.weights[column] = 0;
      wanted = active.solution();
    }
    for (Eigen::Index i = 0; i < wanted.size(); ++i)
      fit.weights[active.columns()[static_cast<std::size_t>(i)]] = wanted[i];
    std::ranges::fill(useless, 0);
  }
  fit.columns = static_cast<int>((fit.weights.array() > 0).count());
  return fit;
}

} // namespace undula::training
