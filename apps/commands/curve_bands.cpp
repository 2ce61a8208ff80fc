#include "apps/commands/curve_bands.hpp"

#include "rom/base/error.hpp"
#include "training/calibration/scene_flows.hpp"

namespace undula::apps {
namespace {

constexpr double part_for_slopes = 0.2; // of tolerances, which may be wide where data narrow them

/// Flows of a scene at the settings of all targets, one after the other, and on every curve behind them, on a
/// level prepared once.
std::vector<double> flows_with_targets(const Scene& moved, std::span<const TargetCurve> targets,
                                       std::span<const Scene> scenes, std::span<const double> heads,
                                       MPI_Comm comm) {
  PhaseTimer timer;
  const auto level = prepare_level(moved, comm, timer);
  std::vector<double> all;
  const auto add = [&](const Scene& scene, std::span<const double> at) {
    const auto flows = scene_flows(*level, scene, at, comm).flow_l_per_min;
    all.insert(all.end(), flows.begin(), flows.end());
  };
  for (const TargetCurve& target : targets) {
    add(at_setting(moved, target), target.head_mmHg);
  }
  for (const Scene& scene : scenes) {
    Scene driven = moved;
    driven.operating_point.voltage = scene.operating_point.voltage;
    add(driven, heads);
  }
  return all;
}

} // namespace

std::vector<CurveBand> bands_of_curves(std::span<const Scene> scenes,
                                       std::span<const std::vector<CurvePoint>> curves, GivenFlows& given,
                                       MPI_Comm comm) {
  std::vector<double> heads;
  for (const CurvePoint& point : curves.front()) {
    heads.push_back(point.head_mmHg);
  }
  const bool alone = scenes.front().space == Space::thin_gap;
  const MPI_Comm curve_comm = alone ? MPI_COMM_SELF : comm;
  const bool has_given = given.measured.size() > 0;
  std::vector<double> nominal;
  if (has_given) {
    nominal = flows_with_targets(scenes.front(), given.targets, {}, heads, curve_comm);
  }
  const std::size_t given_flows = nominal.size();
  for (const auto& curve : curves) {
    for (const CurvePoint& point : curve) {
      nominal.push_back(point.flow_l_per_min);
    }
  }
  const auto band = propagate_tolerances(
      scenes.front(), nominal,
      [&](const Scene& moved) { return flows_with_targets(moved, given.targets, scenes, heads, curve_comm); },
      alone ? comm : MPI_COMM_SELF, has_given ? part_for_slopes : 1.0);
  given.band = part_of_band(band, 0, given_flows);
  given.computed = Eigen::Map<const Eigen::VectorXd>(nominal.data(), static_cast<Eigen::Index>(given_flows));
  std::vector<CurveBand> bands;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const auto curve = part_of_band(band, given_flows + k * heads.size(), heads.size());
    bands.push_back(has_given ? narrowed_band(given, curve) : CurveBand{curve, std::nullopt, 0, {}});
  }
  return bands;
}

std::string draw_curves(std::span<const Scene> scenes, std::span<const std::vector<CurvePoint>> curves,
                        const GivenFlows& given, int count, MPI_Comm comm, std::span<CurveBand> bands) {
  std::vector<double> heads;
  for (const CurvePoint& point : curves.front()) {
    heads.push_back(point.head_mmHg);
  }
  std::vector<FreeKey> keys;
  for (const InputEffect& input : given.band.inputs) {
    keys.push_back({input.key});
  }
  const auto flows = flows_of_scene(scenes.front(), keys, given.targets, comm, {});
  const auto ensemble = draw_inputs(given.band, given.measured, given.deviation, flows, count, 1);
  if (ensemble.values.rows() < 2) {
    throw NumericsError("no flow can be had where the draws lead", std::to_string(count) + " draws",
                        "narrower tolerances, or no --draws");
  }
  Eigen::MatrixXd drawn(ensemble.values.rows(), static_cast<Eigen::Index>(curves.size() * heads.size()));
  for (Eigen::Index row = 0; row < drawn.rows(); ++row) {
    const auto all = flows_with_targets(with_values(scenes.front(), keys, ensemble.values.row(row)), {},
                                        scenes, heads, comm);
    drawn.row(row) = Eigen::Map<const Eigen::VectorXd>(all.data(), drawn.cols());
  }
  return replace_by_draws(ensemble, drawn, curves, bands);
}

} // namespace undula::apps
