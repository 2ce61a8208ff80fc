#include "training/campaign/campaign_store.hpp"

#include <algorithm>

#include "fom/output/scene_difference.hpp"
#include "rom/base/error.hpp"
#include "rom/base/file_format.hpp"
#include "rom/base/text_file.hpp"
#include "training/campaign/run_record_file.hpp"
#include "training/sampling/trainable_scene.hpp"

namespace undula::training {
namespace {

constexpr FileFormat format{"undula campaign", "a campaign", 2};
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

} // namespace

SceneStamp stamp_campaign(const Scene& scene) {
  Scene common = scene;
  common.operating_point = {scene.training.frequency_low, scene.training.stroke_low, scene.training.head_low};
  // What the runs of a moving domain record serves models of both kinds.
  const bool mapped = has_mapped_domain(scene);
  const bool emulated = scene.training.model == ModelKind::emulator || mapped;
  if (emulated) {
    common.operating_point.drive = scene.operating_point.drive;
    common.operating_point.stroke_scale = scene.operating_point.stroke_scale;
    if (scene.operating_point.drive == Drive::voltage) {
      common.operating_point.stroke = scene.operating_point.stroke; // thin gaps take a scale from it
      common.operating_point.voltage = scene.training.voltage_low;
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

CampaignStore::CampaignStore(const std::filesystem::path& folder, const SceneStamp& stamp)
    : records_(folder, {"campaign", format, difference}, stamp) {}

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

RunRecord CampaignStore::load(const OperatingPoint& point) const {
  return read_run_record(record_file(point), records_.hash(), point);
}

} // namespace undula::training
