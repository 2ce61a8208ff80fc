#include "training/campaign/recorded_level.hpp"

#include <utility>

#include "fom/levels/marched_curve.hpp"
#include "rom/base/error.hpp"
#include "rom/base/units.hpp"
#include "training/campaign/campaign.hpp"

namespace undula::training {

RecordedLevel::RecordedLevel(const Scene& scene, const CampaignStore& store, MPI_Comm comm,
                             AfterStep after_step)
    : scene_(scene), store_(store), comm_(comm), after_step_(std::move(after_step)) {}

std::string RecordedLevel::name() const { return "runs of " + scene_.name; }

std::vector<CurvePoint> RecordedLevel::curve(const Scene& scene, std::span<const double> heads_mmHg,
                                             const std::function<void()>& on_point) {
  std::vector<CurvePoint> points;
  for (const double head : heads_mmHg) {
    OperatingPoint at = scene.operating_point;
    at.head = units::pressure_from_mmHg(head);
    const std::vector<OperatingPoint> plan{at};
    const auto is_pending = [&] {
      int pending = static_cast<int>(store_.status(plan).pending.size());
      MPI_Bcast(&pending, 1, MPI_INT, 0, comm_);
      return pending > 0;
    };
    if (is_pending()) {
      run_campaign(scene_, plan, store_, comm_, {}, after_step_);
      MPI_Barrier(comm_); // groups without a run are here before its record is
      if (is_pending())
        throw InputError("the run is being computed by another process",
                         store_.record_file(at).filename().string(), "the same question when it has ended",
                         "--campaign");
      ++runs_;
    }
    points.push_back(curve_point_of(scene_, store_.load(at, RecordParts::without_snapshots)));
    if (on_point) on_point();
  }
  return points;
}

std::vector<std::string> RecordedLevel::remarks(const Scene&, std::span<const double>) const { return {}; }

CurvePoint curve_point_of(const Scene& scene, const RunRecord& record) {
  PeriodicRun run;
  run.state = record.state;
  run.reason = record.reason;
  run.cycles = record.cycles;
  run.plain_periods = record.plain_periods;
  run.blood = scene.blood;
  run.period = 1 / record.point.frequency;
  run.seconds = record.seconds;
  return curve_point(run, units::pressure_to_mmHg(record.point.head));
}

} // namespace undula::training
