#include "training/calibration/bounded_fit.hpp"

#include <nlopt.h>

#include <Eigen/SVD>
#include <algorithm>
#include <exception>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <vector>

#include "rom/base/error.hpp"

namespace undula::training {
namespace {

/// The residuals over the unit box, each point computed once; the best one is kept.
class Sampler {
public:
  Sampler(const Residuals& residuals, Eigen::VectorXd low, Eigen::VectorXd high)
      : residuals_(residuals), low_(std::move(low)), range_(high - low_), high_(std::move(high)) {}

  [[nodiscard]] Eigen::VectorXd at(const Eigen::VectorXd& unit) const {
    // Rounding must not lead out of the box.
    return (low_ + range_.cwiseProduct(unit)).cwiseMax(low_).cwiseMin(high_);
  }

  const std::optional<Eigen::VectorXd>& operator()(const Eigen::VectorXd& unit) {
    const std::vector<double> key(unit.begin(), unit.end());
    const auto known = known_.find(key);
    if (known != known_.end()) return known->second;
    auto value = residuals_(at(unit));
    if (!value) ++refused_;
    return known_.emplace(key, std::move(value)).first->second;
  }

  /// Mean square; of a point without residuals, more than any so far.
  double objective(const Eigen::VectorXd& unit) {
    const auto& value = (*this)(unit);
    if (!value) return worst_factor * worst_;
    const double square = value->squaredNorm() / static_cast<double>(value->size());
    worst_ = std::max(worst_, square);
    if (square < best_) {
      best_ = square;
      best_point_ = unit;
    }
    return square;
  }

  [[nodiscard]] const Eigen::VectorXd& best() const { return best_point_; }
  [[nodiscard]] int points() const { return static_cast<int>(known_.size()); }
  [[nodiscard]] int refused() const { return refused_; }

private:
  static constexpr double worst_factor = 4;
  const Residuals& residuals_;
  Eigen::VectorXd low_, range_, high_;
  std::map<std::vector<double>, std::optional<Eigen::VectorXd>> known_;
  Eigen::VectorXd best_point_;
  double best_ = std::numeric_limits<double>::infinity(), worst_ = std::numeric_limits<double>::min();
  int refused_ = 0;
};

/// What NLopt, a C library, hands through to the objective and back.
struct Search {
  Sampler& sampler;
  nlopt_opt handle;
  std::exception_ptr thrown;
};

double objective(unsigned size, const double* point, double*, void* data) {
  auto& search = *static_cast<Search*>(data);
  try {
    return search.sampler.objective(Eigen::Map<const Eigen::VectorXd>(point, size));
  } catch (...) {
    search.thrown = std::current_exception();
    nlopt_force_stop(search.handle);
    return std::numeric_limits<double>::max();
  }
}

/// Returns whether the steps became as short as asked for.
bool minimise(Sampler& sampler, Eigen::VectorXd start, const FitOptions& options) {
  const auto size = static_cast<unsigned>(start.size());
  const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> handle(nlopt_create(NLOPT_LN_BOBYQA, size),
                                                                 nlopt_destroy);
  Search search{sampler, handle.get(), nullptr};
  nlopt_set_lower_bounds1(handle.get(), 0);
  nlopt_set_upper_bounds1(handle.get(), 1);
  nlopt_set_min_objective(handle.get(), objective, &search);
  nlopt_set_initial_step1(handle.get(), options.first_step);
  nlopt_set_xtol_abs1(handle.get(), options.last_step);
  nlopt_set_maxeval(handle.get(), options.most_points_per_key * static_cast<int>(size));
  double value = 0;
  const nlopt_result result = nlopt_optimize(handle.get(), start.data(), &value);
  if (search.thrown) std::rethrow_exception(search.thrown);
  // At the limit of rounding the steps are shorter still.
  return result == NLOPT_XTOL_REACHED || result == NLOPT_FTOL_REACHED || result == NLOPT_SUCCESS ||
         result == NLOPT_ROUNDOFF_LIMITED;
}

/// Change of the residuals per unit of direction i; nothing where no difference can be had.
std::optional<Eigen::VectorXd> derivative(Sampler& sampler, const Eigen::VectorXd& unit, Eigen::Index i,
                                          double step) {
  constexpr int halvings = 2;
  const auto beside = [&](double change) -> std::optional<Eigen::VectorXd> {
    Eigen::VectorXd point = unit;
    point[i] += change;
    if (point[i] < 0 || point[i] > 1) return std::nullopt;
    return sampler(point);
  };
  for (int halving = 0; halving <= halvings; ++halving, step /= 2) {
    const auto up = beside(step), down = beside(-step);
    if (up && down) return (*up - *down) / (2 * step);
    if (up) return (*up - *sampler(unit)) / step;
    if (down) return (*sampler(unit) - *down) / step;
  }
  return std::nullopt;
}

/// Residuals x directions.
Eigen::MatrixXd jacobian(Sampler& sampler, const Eigen::VectorXd& unit, double step) {
  Eigen::MatrixXd all(sampler(unit)->size(), unit.size());
  for (Eigen::Index i = 0; i < unit.size(); ++i) {
    const auto column = derivative(sampler, unit, i, step);
    if (!column)
      throw NumericsError("no derivative can be computed at the optimum",
                          "direction " + std::to_string(i + 1) + ", to either side",
                          "narrower ranges, or finer steps in time");
    all.col(i) = *column;
  }
  return all;
}

/// Where the linearised residuals are least in the unit box: directions that would leave it are fixed at its
/// side, one after the other, the farthest first. Directions without influence stay where they are.
Eigen::VectorXd linear_optimum(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& residuals,
                               const Eigen::VectorXd& unit) {
  constexpr double no_influence = 1e-4; // singular value, relative to the largest
  Eigen::VectorXd target = unit;
  std::vector<Eigen::Index> free(static_cast<std::size_t>(unit.size()));
  std::iota(free.begin(), free.end(), Eigen::Index{0});
  while (!free.empty()) {
    const Eigen::VectorXd rest = residuals + jacobian * (target - unit); // of what is fixed so far
    Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian(Eigen::all, free),
                                          Eigen::ComputeThinU | Eigen::ComputeThinV);
    svd.setThreshold(no_influence);
    const Eigen::VectorXd step = svd.solve(-rest);
    std::size_t farthest = free.size();
    double excess = 0;
    for (std::size_t k = 0; k < free.size(); ++k) {
      const double value = unit[free[k]] + step[static_cast<Eigen::Index>(k)];
      const double outside = std::max(-value, value - 1);
      if (outside > excess) {
        excess = outside;
        farthest = k;
      }
    }
    if (farthest == free.size()) {
      for (std::size_t k = 0; k < free.size(); ++k)
        target[free[k]] = unit[free[k]] + step[static_cast<Eigen::Index>(k)];
      return target;
    }
    target[free[farthest]] = step[static_cast<Eigen::Index>(farthest)] > 0 ? 1 : 0;
    free.erase(free.begin() + static_cast<std::ptrdiff_t>(farthest));
  }
  return target;
}

/// Steps of Gauss and Newton from the best point. Returns whether they ended by themselves; `slopes` becomes
/// the Jacobian at the best point.
bool descend(Sampler& sampler, Eigen::MatrixXd& slopes, const FitOptions& options) {
  for (int step = 0;; ++step) {
    const Eigen::VectorXd unit = sampler.best();
    slopes = jacobian(sampler, unit, options.difference_step);
    Eigen::VectorXd change = linear_optimum(slopes, *sampler(unit), unit) - unit;
    const double before = sampler.objective(unit);
    if (change.lpNorm<Eigen::Infinity>() < options.least_step) return true;
    if (step == options.most_steps) return false;
    constexpr int halvings = 4;
    bool lower = false;
    for (int halving = 0; halving <= halvings && !lower; ++halving, change /= 2)
      lower = sampler.objective(unit + change) < before;
    if (!lower) return true; // noise, or curvature that the search has seen better
  }
}

} // namespace

BoundedFit fit_within_bounds(const Residuals& residuals, const Eigen::VectorXd& low,
                             const Eigen::VectorXd& high, const Eigen::VectorXd& start,
                             const FitOptions& options) {
  const Eigen::VectorXd range = high - low;
  Sampler sampler(residuals, low, high);
  const Eigen::VectorXd unit_start = (start - low).cwiseQuotient(range).cwiseMax(0).cwiseMin(1);
  if (!sampler(unit_start))
    throw NumericsError("nothing can be computed at the start of the fit", "the values of the scene",
                        "other values by --set, or finer steps in time");
  sampler.objective(unit_start);

  BoundedFit fit;
  fit.converged = !options.search || minimise(sampler, unit_start, options);
  Eigen::MatrixXd slopes;
  fit.converged = descend(sampler, slopes, options) && fit.converged;
  const Eigen::VectorXd best = sampler.best();
  fit.point = sampler.at(best);
  fit.residuals = *sampler(best);
  fit.jacobian = slopes * range.cwiseInverse().asDiagonal();
  fit.points = sampler.points();
  fit.refused = sampler.refused();
  return fit;
}

} // namespace undula::training
