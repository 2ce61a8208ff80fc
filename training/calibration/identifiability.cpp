#include "training/calibration/identifiability.hpp"

#include <Eigen/SVD>
#include <cmath>
#include <limits>

namespace undula::training {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double dependent = 1e-10; // ratio of singular values below which columns are linearly dependent

} // namespace

Identifiability identifiability(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& range,
                                const Eigen::VectorXd& deviation, double least_influence) {
  const Eigen::Index parameters = jacobian.cols();
  const Eigen::MatrixXd per_range = jacobian * range.asDiagonal();
  Identifiability result;
  result.influence = per_range.colwise().norm().transpose() / std::sqrt(static_cast<double>(jacobian.rows()));
  result.standard_error = Eigen::VectorXd::Constant(parameters, infinite);
  result.correlation = Eigen::MatrixXd::Constant(parameters, parameters, unknown);

  // 1. All directions, as the data see them. With fewer residuals than parameters some are not seen at all.
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(per_range, Eigen::ComputeThinU | Eigen::ComputeFullV);
  result.directions = svd.matrixV();
  result.singular_values = Eigen::VectorXd::Zero(parameters);
  result.singular_values.head(svd.singularValues().size()) = svd.singularValues();
  const double largest = result.singular_values[0];
  const double smallest = result.singular_values[parameters - 1];
  result.condition = smallest > 0 ? largest / smallest : infinite;
  result.direction_error = Eigen::VectorXd::Constant(parameters, infinite);
  const double error_of_range = 1 / std::sqrt(12.0);
  for (Eigen::Index i = 0; i < parameters; ++i) {
    const double s = result.singular_values[i];
    if (s > dependent * largest)
      result.direction_error[i] = svd.matrixU().col(i).cwiseProduct(deviation).norm() / s;
    if (!(result.direction_error[i] <= error_of_range))
      result.unfixed_directions.push_back(static_cast<int>(i));
  }

  // 2. Errors and correlations of the parameters that have an influence.
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < parameters; ++i) {
    if (result.influence[i] > least_influence)
      kept.push_back(i);
    else
      result.without_influence.push_back(static_cast<int>(i));
  }
  if (kept.empty()) return result;
  const Eigen::MatrixXd columns = per_range(Eigen::all, kept);
  const Eigen::JacobiSVD<Eigen::MatrixXd> kept_svd(columns, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const auto& values = kept_svd.singularValues();
  if (columns.rows() < columns.cols() || values.tail(1)[0] <= dependent * values[0]) return result;
  const Eigen::MatrixXd spread = kept_svd.matrixV() * values.cwiseInverse().asDiagonal() *
                                 kept_svd.matrixU().transpose() * deviation.asDiagonal();
  const Eigen::MatrixXd covariance = spread * spread.transpose();
  for (std::size_t a = 0; a < kept.size(); ++a) {
    const auto row = static_cast<Eigen::Index>(a);
    result.standard_error[kept[a]] = range[kept[a]] * std::sqrt(covariance(row, row));
    for (std::size_t b = 0; b < kept.size(); ++b) {
      const auto column = static_cast<Eigen::Index>(b);
      const double correlation =
          a == b ? 1 : covariance(row, column) / std::sqrt(covariance(row, row) * covariance(column, column));
      result.correlation(kept[a], kept[b]) = correlation;
      if (a < b && std::abs(correlation) > strong_correlation)
        result.correlated.push_back({static_cast<int>(kept[a]), static_cast<int>(kept[b])});
    }
  }
  return result;
}

} // namespace undula::training
