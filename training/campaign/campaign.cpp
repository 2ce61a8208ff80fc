#include "training/campaign/campaign.hpp"

#include <optional>

#include "fom/levels/finite_element_level.hpp"
#include "training/campaign/recorded_run.hpp"
#include "training/training.hpp"

namespace undula::training {

namespace {

/// A part of the ranks; also freed where a run ends with an exception.
class Group {
public:
  Group(MPI_Comm world, int colour, int key) { MPI_Comm_split(world, colour, key, &comm_); }
  Group(const Group&) = delete;
  Group& operator=(const Group&) = delete;
  ~Group() { MPI_Comm_free(&comm_); }
  operator MPI_Comm() const { return comm_; }

private:
  MPI_Comm comm_ = MPI_COMM_NULL;
};

/// The next point this group may compute, or nothing. Asked on the group's root.
struct NextPoint {
  std::optional<Claim> claim;
  int index = -1;
};

NextPoint claim_next(std::span<const OperatingPoint> plan, const CampaignStore& store) {
  for (std::size_t i = 0; i < plan.size(); ++i)
    if (auto claim = store.try_claim(plan[i])) return {std::move(claim), static_cast<int>(i)};
  return {};
}

} // namespace

void run_campaign(const Scene& scene, std::span<const OperatingPoint> plan, const CampaignStore& store,
                  MPI_Comm world, const CampaignProgress& progress, const AfterStep& after_step) {
  int world_rank = 0;
  MPI_Comm_rank(world, &world_rank);
  const Group group(world, world_rank / scene.training.ranks_per_run, world_rank);
  int rank = 0;
  MPI_Comm_rank(group, &rank);

  // Made when the first point is claimed: a finished plan costs nothing.
  std::unique_ptr<FiniteElementLevel> projected;
  PhaseTimer timer;
  const auto run_of = [&](const Scene& at_point) {
    if (scene.coupling == Coupling::mapped && scene.space != Space::thin_gap) {
      FiniteElementLevel level(at_point, group, timer);
      return record_run(level, at_point, after_step);
    }
    if (scene.training.model == ModelKind::emulator) {
      // Weights may be derived from frequency and stroke: the level is the one that `hq` prepares there.
      const auto level = prepare_level(at_point, group, timer);
      return record_flow(*level, at_point, group, after_step);
    }
    if (!projected) projected = std::make_unique<FiniteElementLevel>(scene, group, timer);
    return record_run(*projected, at_point, after_step);
  };
  for (;;) {
    auto next = rank == 0 ? claim_next(plan, store) : NextPoint{};
    MPI_Bcast(&next.index, 1, MPI_INT, 0, group);
    if (next.index < 0) break;
    Scene at_point = scene;
    at_point.operating_point = plan[static_cast<std::size_t>(next.index)];
    const auto record = run_of(at_point);
    if (rank == 0) {
      store.store(*next.claim, record);
      if (progress) progress(record, plan.size() - store.status(plan).pending.size(), plan.size());
    }
  }
}

} // namespace undula::training
