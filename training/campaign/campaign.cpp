#include "training/campaign/campaign.hpp"

#include <optional>

#include "fom/levels/finite_element_level.hpp"
#include "training/campaign/rank_groups.hpp"
#include "training/campaign/recorded_run.hpp"
#include "training/sampling/trainable_scene.hpp"
#include "training/sampling/varied_keys.hpp"
#include "training/training.hpp"

namespace undula::training {

void run_campaign(const Scene& scene, std::span<const OperatingPoint> plan, const CampaignStore& store,
                  MPI_Comm world, const CampaignProgress& progress, const AfterStep& after_step) {
  const RankGroup group(world, scene.training.ranks_per_run);

  // Made when the first point is claimed: a finished plan costs nothing.
  std::unique_ptr<FiniteElementLevel> projected;
  PhaseTimer timer;
  const auto run_of = [&](const Scene& there) {
    if (has_mapped_domain(scene)) {
      FiniteElementLevel level(there, group, timer);
      return record_run(level, there, after_step);
    }
    if (scene.training.model == ModelKind::emulator) {
      // Weights may be derived from frequency and stroke: the level is the one that `hq` prepares there.
      const auto level = prepare_level(there, group, timer);
      return record_flow(*level, there, group, after_step);
    }
    if (!projected) projected = std::make_unique<FiniteElementLevel>(scene, group, timer);
    return record_run(*projected, there, after_step);
  };
  const auto next = [&]() -> std::optional<std::pair<Claim, int>> {
    for (std::size_t i = 0; i < plan.size(); ++i)
      if (auto claim = store.try_claim(plan[i])) return std::pair(std::move(*claim), static_cast<int>(i));
    return std::nullopt;
  };
  work_off<Claim>(group, next, [&](int number, const Claim* claim) {
    const auto record = run_of(at_point(scene, plan[static_cast<std::size_t>(number)]));
    if (claim == nullptr) return;
    store.store(*claim, record);
    if (progress) progress(record, plan.size() - store.status(plan).pending.size(), plan.size());
  });
}

} // namespace undula::training
