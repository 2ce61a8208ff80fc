// Bounded nonlinear least squares, for residuals that are costly, slightly noisy and
// sometimes missing.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>

namespace undula::training {

/// Residuals at a point of the box; nothing where they cannot be computed.
using Residuals = std::function<std::optional<Eigen::VectorXd>(const Eigen::VectorXd& point)>;

/// Lengths are parts of the box's width in each direction.
struct FitOptions {
  bool search = true;            ///< before the steps of Gauss and Newton
  double first_step = 0.15;      ///< of the search: from the start to the first points around it
  double last_step = 1e-2;       ///< at which the search ends
  double difference_step = 0.05; ///< of derivatives, to both sides
  double least_step = 2e-3;      ///< of Gauss and Newton, at which the fit ends
  int most_steps = 10;           ///< of Gauss and Newton
  int most_points_per_key = 60;  ///< of the search, times the number of directions
};

struct BoundedFit {
  Eigen::VectorXd point;     ///< the best one
  Eigen::VectorXd residuals; ///< there
  Eigen::MatrixXd jacobian;  ///< there: change of every residual (row) per unit of every direction (column)
  bool converged = false;    ///< false: a limit of points or steps was reached
  int points = 0;            ///< asked of the residuals, each once
  int refused = 0;           ///< of them, without residuals
};

/// Minimises the sum of squares within low <= point <= high.
///
/// 1. BOBYQA (Powell 2009, as in NLopt 2.7): quadratic models of the sum through 2 n + 1 points, whose
/// distances
///    shrink from first_step to last_step. It needs no derivatives, and noise below what a step of that
///    length changes does not mislead it. A point without residuals counts as worse than the worst so far: it
///    is never accepted, and the region of trust shrinks away from it.
/// 2. Steps of Gauss and Newton within the bounds, halved up to four times where they do not lower the sum,
///    as long as they do: along a valley the sum hardly tells where its lowest point is, but the residuals
///    do.
///
/// Derivatives are central differences; towards a bound, or a point without residuals, those of the other
/// side alone, with steps halved up to twice where both are missing. Each point is computed once. Finds a
/// local minimum. Throws NumericsError where the start or a derivative cannot be computed; what `residuals`
/// throws comes through. Needs low < high and start within.
BoundedFit fit_within_bounds(const Residuals& residuals, const Eigen::VectorXd& low,
                             const Eigen::VectorXd& high, const Eigen::VectorXd& start,
                             const FitOptions& options = {});

} // namespace undula::training
