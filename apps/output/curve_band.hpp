// The band of a head-flow curve by the tolerances of its scene, narrowed by measured curves where some are
// given.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>

#include "apps/apps.hpp"
#include "training/calibration/calibrate.hpp"
#include "training/calibration/posterior.hpp"

namespace undula::apps {

/// Entries per head of the curve.
struct CurveBand {
  UncertaintyBand tolerances;
  std::optional<Posterior> posterior; ///< where measured curves are given
  double scatter_l_per_min = 0;       ///< standard deviation of a measured sample, of the given curves

  /// Half width of the curve's 95 % interval, l/min.
  double half_width(std::size_t head) const {
    return posterior ? posterior->half_width[head] : tolerances.half_width[head];
  }
  /// The same of a measured sample.
  double half_width_of_samples(std::size_t head) const;
};

/// `count` entries of a band from `first` on.
UncertaintyBand part_of_band(const UncertaintyBand& band, std::size_t first, std::size_t count);

/// From tolerances propagated to the flows of the given curves, one after the other, and to those of `curve`;
/// `nominal` begins with the scene's own given flows. Warns where the data would move the curve by more than
/// half the band: then the scene is not calibrated to them. Throws NumericsError where the scene has no flow
/// at one of the given heads.
CurveBand narrowed_band(const UncertaintyBand& given_flows, std::span<const double> nominal,
                        std::span<const TargetCurve> given, const UncertaintyBand& curve);

/// Every input before and after the data, what they tell of it alone, and strong correlations.
std::string posterior_table(const CurveBand& band);

/// The same as JSON.
nlohmann::ordered_json posterior_json(const CurveBand& band);

} // namespace undula::apps
