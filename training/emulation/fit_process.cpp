#include "training/emulation/fit_process.hpp"

#include <nlopt.h>

#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rom/base/error.hpp"

namespace undula::training {
namespace {

/// Logarithms of lengths, of the process's share and of the nugget's share of the scatter.
struct Search {
  const Eigen::MatrixXd& points;
  const Eigen::VectorXd& values;
  const Eigen::VectorXd& noise;
  double scatter = 0; ///< variance of the values about a linear trend

  rom::ProcessParameters parameters(const double* x) const {
    const auto inputs = points.rows();
    rom::ProcessParameters result;
    result.lengths = Eigen::Map<const Eigen::VectorXd>(x, inputs).array().exp();
    result.variance = scatter * std::exp(x[inputs]);
    result.nugget = scatter * std::exp(x[inputs + 1]);
    return result;
  }

  double operator()(const double* x) const {
    try {
      return rom::GaussianProcess(points, values, noise, parameters(x)).log_likelihood();
    } catch (const NumericsError&) { // points that the covariance cannot tell apart
      return -std::numeric_limits<double>::infinity();
    }
  }
};

/// Variance of what a linear trend leaves over.
double scatter_about_trend(const Eigen::MatrixXd& points, const Eigen::VectorXd& values) {
  Eigen::MatrixXd trend(points.cols(), points.rows() + 1);
  trend << Eigen::VectorXd::Ones(points.cols()), points.transpose();
  const Eigen::VectorXd coefficients = trend.colPivHouseholderQr().solve(values);
  const double square = (values - trend * coefficients).squaredNorm();
  const auto freedom = std::max<Eigen::Index>(1, points.cols() - points.rows() - 1);
  // Values on the trend to rounding have no scatter of their own.
  return std::max(square / static_cast<double>(freedom), 1e-16 * (1e-30 + values.squaredNorm()));
}

double objective(unsigned, const double* x, double*, void* data) {
  const double value = (*static_cast<const Search*>(data))(x);
  return std::isfinite(value) ? -value : 1e300;
}

} // namespace

rom::GaussianProcess fit_process(const Eigen::MatrixXd& points, const Eigen::VectorXd& values,
                                 const Eigen::VectorXd& noise) {
  const auto inputs = static_cast<unsigned>(points.rows());
  // Refuses what is wrong with the input here: nothing may be thrown through NLopt, a C library.
  (void)rom::GaussianProcess(points, values, noise, {Eigen::VectorXd::Ones(points.rows()), 1, 1});
  Search search{points, values, noise, scatter_about_trend(points, values)};
  std::vector<double> low(inputs + 2, std::log(0.05)), high(inputs + 2, std::log(10.0));
  low[inputs] = std::log(1e-2), high[inputs] = std::log(1e3);
  low[inputs + 1] = std::log(1e-8), high[inputs + 1] = std::log(1.0);

  constexpr double tie = 0.1; // in log likelihood
  std::optional<std::vector<double>> best;
  double best_value = -std::numeric_limits<double>::infinity();
  for (const double length : {3.0, 1.0, 0.3})
    for (const double nugget : {1e-6, 1e-2}) {
      std::vector<double> x(inputs + 2, std::log(length));
      x[inputs] = 0;
      x[inputs + 1] = std::log(nugget);
      const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> handle(
          nlopt_create(NLOPT_LN_BOBYQA, inputs + 2), nlopt_destroy);
      nlopt_set_lower_bounds(handle.get(), low.data());
      nlopt_set_upper_bounds(handle.get(), high.data());
      nlopt_set_min_objective(handle.get(), objective, &search);
      nlopt_set_xtol_abs1(handle.get(), 1e-3);
      nlopt_set_maxeval(handle.get(), 400);
      nlopt_set_initial_step1(handle.get(), 0.5);
      double least = 0;
      nlopt_optimize(handle.get(), x.data(), &least); // x is the best point, whatever ended the search
      if (const double value = search(x.data()); value > best_value + (best ? tie : 0)) {
        best_value = value;
        best = x;
      }
    }
  if (!best)
    throw NumericsError("no Gaussian process fits the values of an emulator",
                        std::to_string(points.cols()) + " points", "points that differ");
  return {points, values, noise, search.parameters(best->data())};
}

} // namespace undula::training
