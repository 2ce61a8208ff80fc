#include "training/campaign/run_record_file.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "rom/base/error.hpp"
#include "rom/base/file_format.hpp"
#include "rom/base/text_file.hpp"

namespace undula::training {
namespace {

constexpr int version_without_varied_keys = 2; // training.vary
constexpr FileFormat file_format{"undula run record", "a run record", 3, version_without_varied_keys};

constexpr std::array<std::pair<RunState, const char*>, 4> state_names{
    {{RunState::periodic, "periodic"},
     {RunState::settled, "settled"},
     {RunState::not_periodic, "not periodic"},
     {RunState::failed, "failed"}}};

std::string name_of(RunState state) {
  for (const auto& [value, name] : state_names)
    if (value == state) return name;
  return {};
}

RunState state_of(const std::string& seen, const std::filesystem::path& file) {
  for (const auto& [value, name] : state_names)
    if (seen == name) return value;
  throw InputError("unknown state of a run", seen, "periodic, settled, not periodic, failed", file.string());
}

OperatingPoint read_point(const Hdf5File& file) {
  const auto get = [&](const char* name) { return file.read<double>(name, {}).front(); };
  OperatingPoint point{get("point/frequency"), get("point/stroke"), get("point/head")};
  if (file.exists("point/voltage")) {
    point.drive = Drive::voltage;
    point.voltage = get("point/voltage");
  }
  if (file.exists("point/varied"))
    for (const auto& key : file.children("point/varied")) {
      const auto dataset = "point/varied/" + key;
      point.varied[key] = file.read<double>(dataset, {}).front();
    }
  return point;
}

std::string point_text(const OperatingPoint& point) {
  std::string text = exact_number(point.frequency) + " Hz, " +
                     (point.drive == Drive::voltage ? exact_number(point.voltage) + " V, "
                                                    : exact_number(point.stroke) + " cm, ") +
                     exact_number(point.head) + " dyn/cm^2";
  for (const auto& [key, value] : point.varied) text += ", " + key + " = " + exact_number(value);
  return text;
}

Hdf5File open_of_campaign(const std::filesystem::path& path, const std::string& campaign_hash) {
  auto file = Hdf5File::open_sealed(path);
  checked_version(file, file_format);
  const auto hash = file.read_attribute<std::string>("/", "campaign_hash");
  if (hash != campaign_hash)
    throw InputError("the record belongs to another campaign", "campaign hash " + hash,
                     "campaign hash " + campaign_hash, path.string());
  return file;
}

Hdf5File open_checked(const std::filesystem::path& path, const std::string& campaign_hash,
                      const OperatingPoint& point) {
  auto file = open_of_campaign(path, campaign_hash);
  if (const auto there = read_point(file); !same_point(there, point))
    throw InputError("the record is that of another point", point_text(there), point_text(point),
                     path.string());
  return file;
}

void check_shapes(const RunRecord& record, const std::filesystem::path& file) {
  const auto fail = [&](const std::string& what, std::size_t seen, std::size_t allowed) {
    throw InputError("run record does not fit together: " + what, std::to_string(seen),
                     std::to_string(allowed), file.string());
  };
  for (const auto& [name, field] : record.snapshots)
    if (const auto columns = static_cast<std::size_t>(field.values.cols()); columns != record.times.size())
      fail("snapshots of " + name, columns, record.times.size());
  for (const double time : record.times)
    if (!std::isfinite(time))
      throw InputError("run record with a time that is no number", std::to_string(time), "finite times",
                       file.string());
  const auto& cycles = record.cycles;
  const auto count = cycles.columns.size() * cycles.periods.size();
  for (const auto* values : {&cycles.mean, &cycles.minimum, &cycles.maximum})
    if (values->size() != count) fail("cycle means", values->size(), count);
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const auto& name : names) text += name + "\n";
  return text;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const auto end = text.find('\n', begin);
    lines.push_back(text.substr(begin, end - begin));
    begin = end == std::string::npos ? text.size() : end + 1;
  }
  return lines;
}

} // namespace

OperatingPoint point_of_record(const std::filesystem::path& path, const std::string& campaign_hash) {
  return read_point(open_of_campaign(path, campaign_hash));
}

bool same_point(const OperatingPoint& a, const OperatingPoint& b) {
  return a.frequency == b.frequency && a.head == b.head && a.drive == b.drive &&
         (a.drive == Drive::voltage ? a.voltage == b.voltage : a.stroke == b.stroke) && a.varied == b.varied;
}

void write_run_record(const RunRecord& record, const std::string& campaign_hash,
                      const std::filesystem::path& target) {
  check_shapes(record, target);
  auto file = Hdf5File::create(target);
  file.write_attribute("/", "format", format_text(file_format));
  file.write_attribute("/", "campaign_hash", campaign_hash);
  file.write_attribute("/", "state", name_of(record.state));
  file.write_text("reason", record.reason);
  const auto put = [&](const std::string& name, double value, const char* unit) {
    file.write(name, std::span(&value, 1), {}, unit);
  };
  put("point/frequency", record.point.frequency, "Hz");
  put("point/stroke", record.point.stroke, "cm");
  put("point/head", record.point.head, "dyn/cm^2");
  if (record.point.drive == Drive::voltage) put("point/voltage", record.point.voltage, "V");
  if (!record.point.varied.empty()) file.create_group("point/varied");
  for (const auto& [key, value] : record.point.varied)
    file.write("point/varied/" + key, std::span(&value, 1), {});
  file.write("times", std::span(record.times), {record.times.size()}, "s");
  // A column-major [unknown][snapshot] matrix is a row-major [snapshot][unknown] array.
  file.create_group("snapshots");
  for (const auto& [name, field] : record.snapshots)
    file.write("snapshots/" + name,
               std::span(field.values.data(), static_cast<std::size_t>(field.values.size())),
               {static_cast<std::size_t>(field.values.cols()), static_cast<std::size_t>(field.values.rows())},
               field.unit);
  const auto& cycles = record.cycles;
  const Hdf5File::Shape shape{cycles.periods.size(), cycles.columns.size()};
  file.write_text("cycles/columns", joined(cycles.columns));
  file.write("cycles/periods", std::span(cycles.periods));
  file.write("cycles/plain_periods", std::vector<int>{record.plain_periods});
  file.write("cycles/mean", std::span(cycles.mean), shape);
  file.write("cycles/minimum", std::span(cycles.minimum), shape);
  file.write("cycles/maximum", std::span(cycles.maximum), shape);
  file.create_group("seconds");
  for (const auto& [phase, seconds] : record.seconds) put("seconds/" + phase, seconds, "s");
  file.commit();
}

RunRecord read_run_record(const std::filesystem::path& path, const std::string& campaign_hash,
                          const OperatingPoint& point, RecordParts parts) {
  const auto file = open_checked(path, campaign_hash, point);
  RunRecord record;
  record.point = point;
  record.state = state_of(file.read_attribute<std::string>("/", "state"), path);
  record.reason = file.read_text("reason");
  if (parts == RecordParts::all) record.times = file.read<double>("times");
  for (const auto& name :
       parts == RecordParts::all ? file.children("snapshots") : std::vector<std::string>{}) {
    const auto dataset = "snapshots/" + name;
    const auto extents = file.extents(dataset);
    if (extents.size() != 2)
      throw InputError("snapshots of " + name + " are no matrix",
                       std::to_string(extents.size()) + " dimensions", "2", path.string());
    const auto values = file.read<double>(dataset);
    record.snapshots[name] = {file.unit(dataset), Eigen::Map<const Eigen::MatrixXd>(
                                                      values.data(), static_cast<Eigen::Index>(extents[1]),
                                                      static_cast<Eigen::Index>(extents[0]))};
  }
  record.cycles.columns = lines_of(file.read_text("cycles/columns"));
  record.cycles.periods = file.read<int>("cycles/periods");
  if (file.exists("cycles/plain_periods"))
    record.plain_periods = file.read<int>("cycles/plain_periods", {1}).front();
  record.cycles.mean = file.read<double>("cycles/mean");
  record.cycles.minimum = file.read<double>("cycles/minimum");
  record.cycles.maximum = file.read<double>("cycles/maximum");
  for (const auto& phase : file.children("seconds"))
    record.seconds[phase] = file.read<double>("seconds/" + phase, {}).front();
  check_shapes(record, path);
  return record;
}

void check_run_record(const std::filesystem::path& path, const std::string& campaign_hash,
                      const OperatingPoint& point) {
  const auto file = open_checked(path, campaign_hash, point);
  state_of(file.read_attribute<std::string>("/", "state"), path);
  // The seal vouches for the bytes; what is asked for here is that nothing is missing.
  for (const auto* name : {"reason", "point", "times", "snapshots", "cycles", "seconds"})
    if (!file.exists(name))
      throw InputError("incomplete run record", std::string("no '") + name + "'", "a whole record",
                       path.string());
}

} // namespace undula::training
