// The band of a head-flow curve by the tolerances of its scene, narrowed by measured curves where some are
// given.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/apps.hpp"
#include "fom/levels/curve_point.hpp"
#include "training/calibration/calibrate.hpp"
#include "training/calibration/posterior.hpp"

namespace undula::apps {

/// Entries per head of the curve.
struct CurveBand {
  UncertaintyBand tolerances;
  std::optional<Posterior> posterior;      ///< where measured curves are given
  double scatter_l_per_min = 0;            ///< standard deviation of a measured sample, of the given curves
  std::vector<double> half_width_of_draws; ///< 95 % of drawn curves; empty: none are drawn

  /// Half width of the curve's 95 % interval, l/min.
  double half_width(std::size_t head) const {
    if (!half_width_of_draws.empty()) {
      return half_width_of_draws[head];
    }
    return posterior ? posterior->half_width[head] : tolerances.half_width[head];
  }
  /// The same of a measured sample.
  double half_width_of_samples(std::size_t head) const;
};

/// `count` entries of a band from `first` on.
UncertaintyBand part_of_band(const UncertaintyBand& band, std::size_t first, std::size_t count);

/// Measured curves that narrow a band, one after the other.
struct GivenFlows {
  std::span<const TargetCurve> targets;
  Eigen::VectorXd measured, deviation; ///< l/min; standard deviation of a sample, with the noise of the flows
  Eigen::VectorXd computed;            ///< by the scene
  UncertaintyBand band;                ///< of the computed ones by the tolerances
};

/// The measured part.
GivenFlows given_flows(std::span<const TargetCurve> targets);

/// `curve`: the tolerances propagated to a curve. Warns where the data would move it by more than half the
/// band: then the scene is not calibrated to them. Throws NumericsError where the scene has no flow at one of
/// the given heads.
CurveBand narrowed_band(const GivenFlows& given, const UncertaintyBand& curve);

/// What a posterior becomes by draws: the bands of the curves, and one sentence. `flows` holds a row per
/// draw: all curves one after the other.
std::string replace_by_draws(const PosteriorEnsemble& ensemble, const Eigen::MatrixXd& flows,
                             std::span<const std::vector<CurvePoint>> curves, std::span<CurveBand> bands);

/// Every input before and after the data, what they tell of it alone, and strong correlations.
std::string posterior_table(const CurveBand& band);

/// The same as JSON.
nlohmann::ordered_json posterior_json(const CurveBand& band);

} // namespace undula::apps
