#include "training/campaign/campaign_store.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <set>
#include <utility>

#include "fom/output/scene_difference.hpp"
#include "rom/base/error.hpp"
#include "rom/base/hdf5_file.hpp"
#include "rom/base/text_file.hpp"
#include "training/campaign/run_record_file.hpp"

namespace undula::training {
namespace {

constexpr const char* format = "undula campaign 2";
constexpr const char* stamp_name = "campaign.h5";

enum class Wait { no, yes };

/// Descriptor that holds the lock, or -1 if another process has it and we do not wait.
int lock(const std::filesystem::path& file, Wait wait) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor < 0)
    throw InputError("cannot create a lock file", std::strerror(errno), "a writable folder", file.string());
  int result = 0;
  do result = ::flock(descriptor, wait == Wait::yes ? LOCK_EX : LOCK_EX | LOCK_NB);
  while (result != 0 && errno == EINTR);
  if (result == 0) return descriptor;
  const int reason = errno;
  ::close(descriptor);
  if (reason == EWOULDBLOCK) return -1;
  throw InputError("cannot lock a file of the campaign", std::strerror(reason), "a file system with flock",
                   file.string());
}

/// The lock of a record (or of the stamp) lies beside it. It is removed only where the whole record is in
/// place: whoever still gets hold of the removed file then finds the point done.
std::filesystem::path lock_file(std::filesystem::path record) { return record.replace_extension(".lock"); }

void remove_partials(const std::filesystem::path& target) {
  const auto prefix = target.filename().string() + ".";
  for (const auto& entry : std::filesystem::directory_iterator(target.parent_path())) {
    const auto name = entry.path().filename().string();
    std::error_code gone; // by another process that cleans up as well
    if (name.starts_with(prefix) && name.ends_with(".partial")) std::filesystem::remove(entry.path(), gone);
  }
}

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

void check_stamp(const std::filesystem::path& path, const SceneStamp& stamp) {
  const auto file = Hdf5File::open_sealed(path);
  const auto seen =
      file.has_attribute("/", "format") ? file.read_attribute<std::string>("/", "format") : "none";
  if (seen != format) throw InputError("not a campaign", "format: " + seen, format, path.string());
  const auto hash = file.read_attribute<std::string>("/", "campaign_hash");
  if (hash != stamp.hash)
    throw InputError("the folder holds the campaign of another scene",
                     "campaign hash " + hash + "; " + difference(file.read_text("scene"), stamp.text),
                     "campaign hash " + stamp.hash + ", or another folder", path.string());
}

} // namespace

SceneStamp stamp_campaign(const Scene& scene) {
  Scene common = scene;
  common.operating_point = {scene.training.frequency_low, scene.training.stroke_low, scene.training.head_low};
  // What the runs of a moving domain record serves models of both kinds.
  const bool mapped = scene.space != Space::thin_gap && scene.coupling == Coupling::mapped;
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

Claim::Claim(Claim&& other) noexcept : lock_(std::exchange(other.lock_, -1)), point_(other.point_) {}

Claim::~Claim() {
  if (lock_ >= 0) ::close(lock_);
}

CampaignStore::CampaignStore(const std::filesystem::path& folder, const SceneStamp& stamp)
    : folder_(std::filesystem::absolute(folder)), stamp_(stamp) {
  check_or_create_stamp();
  remove_leftovers();
}

void CampaignStore::check_or_create_stamp() const {
  const auto path = folder_ / stamp_name;
  if (std::filesystem::exists(path)) return check_stamp(path, stamp_);
  std::filesystem::create_directories(folder_);
  for (const auto& entry : std::filesystem::directory_iterator(folder_))
    if (!entry.path().filename().string().starts_with(stamp_name) && entry.path().extension() != ".lock")
      throw InputError("the folder is not a campaign", "\"" + entry.path().filename().string() + "\"",
                       "an empty or missing folder, or one with " + std::string(stamp_name),
                       folder_.string());
  // Two processes may find the folder empty at the same time; the second one then checks the first one's
  // stamp.
  const Claim guard(lock(lock_file(path), Wait::yes), {});
  if (std::filesystem::exists(path)) return check_stamp(path, stamp_);
  auto file = Hdf5File::create(path);
  file.write_attribute("/", "format", format);
  file.write_attribute("/", "campaign_hash", stamp_.hash);
  file.write_text("scene", stamp_.text);
  file.commit();
  std::filesystem::remove(lock_file(path));
}

void CampaignStore::remove_leftovers() const {
  std::set<std::filesystem::path> records;
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    const auto name = entry.path().filename().string();
    const auto end = name.find(".h5.");
    if (end != std::string::npos && name.ends_with(".partial"))
      records.insert(folder_ / name.substr(0, end + 3));
  }
  for (const auto& record : records) {
    // A temporary file whose lock is held is being written at this moment.
    const Claim owner(lock(lock_file(record), Wait::no), {});
    if (owner.lock_ >= 0) remove_partials(record);
  }
}

std::filesystem::path CampaignStore::record_file(const OperatingPoint& point) const {
  const std::string drive =
      point.drive == Drive::voltage ? exact_number(point.voltage) + "V_" : exact_number(point.stroke) + "cm_";
  return folder_ /
         (exact_number(point.frequency) + "Hz_" + drive + exact_number(point.head) + "dyn_per_cm2.h5");
}

bool CampaignStore::is_done(const OperatingPoint& point) const {
  return status(std::span(&point, 1)).pending.empty();
}

void CampaignStore::check_record(const std::filesystem::path& file, const OperatingPoint& point) const {
  std::error_code gone;
  const auto changed = std::filesystem::last_write_time(file, gone);
  if (const auto known = checked_.find(file); !gone && known != checked_.end() && known->second == changed)
    return;
  check_run_record(file, stamp_.hash, point);
  checked_[file] = changed;
}

CampaignStore::Status CampaignStore::status(std::span<const OperatingPoint> plan) const {
  Status result;
  for (const auto& point : plan) {
    const auto file = record_file(point);
    try {
      if (std::filesystem::exists(file)) {
        check_record(file, point);
        continue;
      }
    } catch (const InputError& error) {
      result.damaged.emplace_back(error.what());
    }
    result.pending.push_back(point);
  }
  return result;
}

std::optional<Claim> CampaignStore::try_claim(const OperatingPoint& point) const {
  if (is_done(point)) return std::nullopt;
  const auto record = record_file(point);
  Claim claim(lock(lock_file(record), Wait::no), point);
  if (claim.lock_ < 0) return std::nullopt;
  // Only now is it certain that nobody stores this point between the question and the answer.
  if (is_done(point)) {
    std::filesystem::remove(lock_file(record));
    return std::nullopt;
  }
  remove_partials(record);
  return claim;
}

void CampaignStore::store(const Claim& claim, const RunRecord& record) const {
  if (!same_point(claim.point(), record.point))
    throw InputError("a record may be stored at its own point only",
                     record_file(record.point).filename().string(),
                     record_file(claim.point()).filename().string(), folder_.string());
  const auto file = record_file(record.point);
  write_run_record(record, stamp_.hash, file);
  std::filesystem::remove(lock_file(file));
}

std::vector<OperatingPoint> CampaignStore::recorded_points() const {
  std::set<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder_))
    if (entry.path().extension() == ".h5" && entry.path().filename() != stamp_name)
      files.insert(entry.path());
  std::vector<OperatingPoint> points;
  for (const auto& file : files) {
    try {
      points.push_back(point_of_record(file, stamp_.hash));
    } catch (const InputError&) { // no record of this campaign: nothing to learn from
    }
  }
  return points;
}

RunRecord CampaignStore::load(const OperatingPoint& point) const {
  return read_run_record(record_file(point), stamp_.hash, point);
}

} // namespace undula::training
