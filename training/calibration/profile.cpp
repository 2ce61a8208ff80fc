#include "training/calibration/profile.hpp"

#include "rom/base/error.hpp"

namespace undula::training {

std::vector<ProfilePoint> profile_likelihood(const FlowsAtValue& flows, const ProfileRequest& request,
                                             std::span<const FreeKey> keys, const Eigen::VectorXd& best,
                                             std::span<const TargetCurve> targets,
                                             const std::function<void()>& on_point) {
  std::vector<FreeKey> others;
  Eigen::VectorXd start(best.size() - 1);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i].key == request.key) continue;
    start[static_cast<Eigen::Index>(others.size())] = best[static_cast<Eigen::Index>(i)];
    others.push_back(keys[i]);
  }
  FitOptions options;
  options.search = false; // every fit begins near its end
  std::vector<ProfilePoint> profile;
  for (const double value : request.values) {
    ProfilePoint point;
    point.value = value;
    try {
      const auto fit = calibrate(flows(value, others), others, start, targets, options);
      point.computed = true;
      point.misfit = fit.misfit;
      point.others = fit.optimum;
      for (const CalibratedCurve& curve : fit.curves)
        point.rms_l_per_min.push_back(curve.optimum_rms_l_per_min);
    } catch (const NumericsError&) { // nothing can be computed there
    }
    profile.push_back(std::move(point));
    if (on_point) on_point();
  }
  return profile;
}

} // namespace undula::training
