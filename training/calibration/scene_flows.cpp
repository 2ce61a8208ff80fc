#include "training/calibration/scene_flows.hpp"

#include <cmath>
#include <limits>
#include <optional>

#include "rom/base/error.hpp"

namespace undula::training {

SceneFlows scene_flows(Level& level, const Scene& scene, std::span<const double> heads_mmHg, MPI_Comm comm) {
  SceneFlows flows;
  for (const CurvePoint& point : level.curve(scene, heads_mmHg)) {
    flows.flow_l_per_min.push_back(point.flow_l_per_min);
    if (!std::isfinite(point.flow_l_per_min) && flows.failure.empty()) flows.failure = point.reason;
    if (std::isfinite(point.flow_l_per_min) && !point.periodic) ++flows.not_periodic;
  }
  // Searches decide on these numbers, on every rank alike.
  MPI_Bcast(flows.flow_l_per_min.data(), static_cast<int>(flows.flow_l_per_min.size()), MPI_DOUBLE, 0, comm);
  return flows;
}

SceneFlows scene_flows(const Scene& scene, std::span<const double> heads_mmHg, MPI_Comm comm) {
  std::string reason;
  try {
    PhaseTimer timer;
    const auto level = prepare_level(scene, comm, timer);
    return scene_flows(*level, scene, heads_mmHg, comm);
  } catch (const InputError& error) {
    reason = error.what();
  } catch (const NumericsError& error) {
    reason = error.what();
  }
  SceneFlows none;
  none.flow_l_per_min.assign(heads_mmHg.size(), std::numeric_limits<double>::quiet_NaN());
  none.failure = reason;
  return none;
}

} // namespace undula::training
