#include "training/study/study_store.hpp"

#include "fom/output/scene_difference.hpp"
#include "rom/base/error.hpp"
#include "rom/base/file_format.hpp"
#include "rom/base/text_file.hpp"

namespace undula::training {
namespace {

constexpr FileFormat stamp_format{"undula study", "a study", 1};
constexpr FileFormat record_format{"undula study record", "a record of a study", 1};

std::string joined(const std::vector<double>& values, const char* separator) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : separator) + exact_number(value);
  return text;
}

std::string difference(const std::string& before, const std::string& now) {
  auto keys = differing_keys(before, now);
  std::erase_if(keys, [](const KeyDifference& one) { return one.key == "name"; });
  if (keys.empty()) return "other keys are varied, or a file that the scene names has changed";
  return difference_text(keys);
}

/// The file of a record, once it is certain what it is.
Hdf5File open_checked(const std::filesystem::path& path, const std::string& hash,
                      const std::vector<double>& values) {
  auto file = Hdf5File::open_sealed(path);
  checked_version(file, record_format);
  if (const auto there = file.read_attribute<std::string>("/", "study_hash"); there != hash)
    throw InputError("the record belongs to another study", "study hash " + there, "study hash " + hash,
                     path.string());
  if (const auto there = file.read<double>("values"); there != values)
    throw InputError("the record is that of another run", joined(there, ", "), joined(values, ", "),
                     path.string());
  for (const char* name : {"reason", "quantities/names", "quantities/values", "seconds"})
    if (!file.exists(name))
      throw InputError("incomplete record of a study", std::string("no '") + name + "'", "a whole record",
                       path.string());
  return file;
}

} // namespace

SceneStamp stamp_study(const Scene& scene, std::span<const std::string> keys) {
  SceneStamp stamp = stamp_scene(scene);
  // Keys that leave a state as it is, but not what is made of it.
  for (const double value :
       {static_cast<double>(scene.time.periods), scene.training.periodic_tolerance, scene.time.flow_error,
        scene.time.end, scene.output.statistics_from, scene.blood.coefficient, scene.blood.stress_exponent,
        scene.blood.time_exponent, scene.blood.threshold})
    stamp.hash += "-" + exact_number(value);
  for (const std::string& key : keys) stamp.hash += "-" + key;
  return stamp;
}

StudyStore::StudyStore(const std::filesystem::path& folder, const SceneStamp& stamp)
    : records_(folder, {"study", stamp_format, difference}, stamp) {}

RecordStore::Check StudyStore::check_of(const std::vector<double>& values) const {
  return [this, values](const std::filesystem::path& file) { open_checked(file, records_.hash(), values); };
}

std::vector<std::size_t> StudyStore::pending(const StudyPlan& plan, std::vector<std::string>* damaged) const {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < plan.points.size(); ++i)
    if (!records_.is_done(joined(plan.points[i], "_"), check_of(plan.points[i]), damaged))
      result.push_back(i);
  return result;
}

std::optional<RecordClaim> StudyStore::try_claim(const std::vector<double>& values) const {
  return records_.try_claim(joined(values, "_"), check_of(values));
}

void StudyStore::store(const RecordClaim& claim, const StudyRecord& record) const {
  if (claim.name() != joined(record.values, "_"))
    throw InputError("a record may be stored at its own values only", joined(record.values, ", "),
                     claim.name(), records_.folder().string());
  auto file = Hdf5File::create(records_.file(claim.name()));
  file.write_attribute("/", "format", format_text(record_format));
  file.write_attribute("/", "study_hash", records_.hash());
  file.write_attribute("/", "state", record.state);
  file.write_text("reason", record.reason);
  file.write("values", std::span(record.values));
  std::string names;
  std::vector<double> values;
  for (const StudyQuantity& one : record.quantities) {
    names += one.name + "\n";
    values.push_back(one.value);
  }
  file.write_text("quantities/names", names);
  file.write("quantities/values", std::span(values));
  file.write("seconds", std::span(&record.seconds, 1), {}, "s");
  file.commit();
  records_.release(claim);
}

StudyRecord StudyStore::load(const std::vector<double>& values) const {
  const auto path = records_.file(joined(values, "_"));
  const auto file = open_checked(path, records_.hash(), values);
  StudyRecord record;
  record.values = values;
  record.state = file.read_attribute<std::string>("/", "state");
  record.reason = file.read_text("reason");
  record.seconds = file.read<double>("seconds", {}).front();
  const auto numbers = file.read<double>("quantities/values");
  const auto names = file.read_text("quantities/names");
  std::size_t begin = 0;
  for (const double number : numbers) {
    const auto end = names.find('\n', begin);
    if (end == std::string::npos)
      throw InputError("a record of a study has fewer names than numbers", std::to_string(numbers.size()),
                       "as many", path.string());
    record.quantities.push_back({names.substr(begin, end - begin), number});
    begin = end + 1;
  }
  return record;
}

} // namespace undula::training
