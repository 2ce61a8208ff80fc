#include "training/campaign/campaign_store.hpp"

#include <algorithm>
#include <utility>

#include "fom/output/scene_difference.hpp"
#include "rom/base/error.hpp"
#include "rom/base/file_format.hpp"
#include "rom/base/hdf5_file.hpp"
#include "rom/base/text_file.hpp"
#include "training/campaign/run_record_file.hpp"
#include "training/sampling/trainable_scene.hpp"

namespace undula::training {
namespace {

constexpr int stamped_at_a_corner = 2; // of the box
constexpr FileFormat format{"undula campaign", "a campaign", 3, stamped_at_a_corner};
constexpr FileFormat format_2{"undula campaign", "a campaign", stamped_at_a_corner};

/// Which keys of the scenes of two campaigns differ, of those that may matter.
std::string difference(const std::string& before, const std::string& now) {
  auto keys = differing_keys(before, now);
  std::erase_if(keys, [](const KeyDifference& one) {
    const bool along_the_box =
        one.key == "operating_point.frequency_Hz" || one.key == "operating_point.stroke_mm" ||
        one.key == "operating_point.voltage_V" || one.key == "operating_point.head_mmHg";
    return one.key == "name" || one.key.starts_with("output.") || along_the_box;
  });
  return difference_text(keys);
}

/// Name of the record of a point.
std::string record_name(const OperatingPoint& point) {
  const std::string drive =
      point.drive == Drive::voltage ? exact_number(point.voltage) + "V_" : exact_number(point.stroke) + "cm_";
  std::string name = exact_number(point.frequency) + "Hz_" + drive + exact_number(point.head) + "dyn_per_cm2";
  for (const auto& [key, value] : point.varied) name += "_" + key + "=" + exact_number(value);
  return name;
}

/// The stamp of a scene whose operating point is replaced by `at`.
SceneStamp stamp_at(const Scene& scene, const OperatingPoint& at) {
  Scene common = scene;
  common.operating_point = {at.frequency, at.stroke, at.head};
  // What the runs of a moving domain record serves models of both kinds.
  const bool mapped = has_mapped_domain(scene);
  const bool emulated = scene.training.model == ModelKind::emulator || mapped;
  if (emulated) {
    common.operating_point.drive = scene.operating_point.drive;
    common.operating_point.stroke_scale = scene.operating_point.stroke_scale;
    if (scene.operating_point.drive == Drive::voltage) {
      common.operating_point.stroke = scene.operating_point.stroke; // thin gaps take a scale from it
      common.operating_point.voltage = at.voltage;
    }
  }
  auto stamp = stamp_scene(common);
  stamp.hash += "-" + std::to_string(scene.time.periods) + "-" +
                std::to_string(scene.training.sampled_periods) + "-" +
                std::to_string(scene.training.snapshots_per_period) + "-" +
                exact_number(scene.training.periodic_tolerance) +
                (emulated ? "-flows-" + exact_number(scene.time.flow_error) : "");
  return stamp;
}

OperatingPoint point_at(double frequency, double stroke, double head, double voltage) {
  OperatingPoint point{frequency, stroke, head};
  point.voltage = voltage;
  return point;
}

RecordKind kind_of_campaign(const FileFormat& of_version) { return {"campaign", of_version, difference}; }

} // namespace

SceneStamp stamp_campaign(const Scene& scene) { return stamp_at(scene, point_at(1, 1, 0, 1)); }

SceneStamp stamp_campaign_of_version_2(const Scene& scene) {
  const auto& box = scene.training;
  return stamp_at(scene, point_at(box.frequency_low, box.stroke_low, box.head_low, box.voltage_low));
}

CampaignStore::CampaignStore(const std::filesystem::path& folder, const SceneStamp& stamp)
    : records_(folder, kind_of_campaign(format), stamp) {}

CampaignStore::CampaignStore(RecordStore records) : records_(std::move(records)) {}

CampaignStore CampaignStore::of_scene(const std::filesystem::path& folder, const Scene& scene) {
  const auto stamp = folder / "campaign.h5";
  std::error_code ignored;
  if (std::filesystem::exists(stamp, ignored) &&
      checked_version(Hdf5File::open_sealed(stamp), format) == stamped_at_a_corner)
    return CampaignStore(RecordStore(folder, kind_of_campaign(format_2), stamp_campaign_of_version_2(scene)));
  return {folder, stamp_campaign(scene)};
}

std::filesystem::path CampaignStore::record_file(const OperatingPoint& point) const {
  return records_.file(record_name(point));
}

RecordStore::Check CampaignStore::check_of(const OperatingPoint& point) const {
  return [this, point](const std::filesystem::path& file) { check_run_record(file, records_.hash(), point); };
}

bool CampaignStore::is_done(const OperatingPoint& point, std::vector<std::string>* damaged) const {
  return records_.is_done(record_name(point), check_of(point), damaged);
}

CampaignStore::Status CampaignStore::status(std::span<const OperatingPoint> plan) const {
  Status result;
  for (const auto& point : plan)
    if (!is_done(point, &result.damaged)) result.pending.push_back(point);
  return result;
}

std::optional<Claim> CampaignStore::try_claim(const OperatingPoint& point) const {
  auto record = records_.try_claim(record_name(point), check_of(point));
  if (!record) return std::nullopt;
  return Claim(std::move(*record), point);
}

void CampaignStore::store(const Claim& claim, const RunRecord& record) const {
  if (!same_point(claim.point(), record.point))
    throw InputError("a record may be stored at its own point only",
                     record_file(record.point).filename().string(),
                     record_file(claim.point()).filename().string(), records_.folder().string());
  write_run_record(record, records_.hash(), record_file(record.point));
  records_.release(claim.record_);
}

std::vector<OperatingPoint> CampaignStore::recorded_points(std::vector<std::string>& damaged) const {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(records_.folder()))
    if (entry.path().extension() == ".h5" && entry.path().filename() != "campaign.h5")
      files.push_back(entry.path());
  std::ranges::sort(files);
  std::vector<OperatingPoint> points;
  for (const auto& file : files) {
    try {
      const auto point = point_of_record(file, records_.hash());
      check_run_record(file, records_.hash(), point);
      points.push_back(point);
    } catch (const LaterFormatError&) {
      throw; // not damaged
    } catch (const InputError& error) {
      damaged.emplace_back(error.what());
    }
  }
  return points;
}

RunRecord CampaignStore::load(const OperatingPoint& point, RecordParts parts) const {
  return read_run_record(record_file(point), records_.hash(), point, parts);
}

} // namespace undula::training
