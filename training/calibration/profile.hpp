// Profile likelihood: the best misfit that remains where one key of a calibration is held at given values.
//
// Where a fit depends on the key as on a parameter of normal data, the misfit rises by 3.84 at the ends of
// its 95 % interval (Venzon & Moolgavkar 1988). A flat profile says that the data do not tell the key.
#pragma once

#include <functional>

#include "training/calibration/calibrate.hpp"

namespace undula::training {

struct ProfilePoint {
  double value = 0;       ///< of the profiled key, its unit
  bool computed = false;  ///< false: no flows there, or no fit
  double misfit = 0;      ///< Calibration::misfit, the profiled key's own tolerance left out
  Eigen::VectorXd others; ///< best values of the other keys, in the order of `keys` without the profiled one
  std::vector<double> rms_l_per_min; ///< per curve
};

/// The profiled key and values for it.
struct ProfileRequest {
  std::string key;
  std::vector<double> values;
};

/// Flows with the profiled key at `value`, as a function of the others.
using FlowsAtValue = std::function<FlowsOfValues(double value, std::span<const FreeKey> others)>;

/// One fit per value, each from `best`, the values of `keys` at the end of the whole fit. `on_point` is
/// called after each.
std::vector<ProfilePoint> profile_likelihood(const FlowsAtValue& flows, const ProfileRequest& request,
                                             std::span<const FreeKey> keys, const Eigen::VectorXd& best,
                                             std::span<const TargetCurve> targets,
                                             const std::function<void()>& on_point = {});

} // namespace undula::training
