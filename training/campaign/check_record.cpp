#include "training/campaign/check_record.hpp"

#include "rom/base/error.hpp"

namespace undula::training {

void refuse_record(const std::string& what, const std::string& seen, const std::string& allowed,
                   const std::string& file) {
  throw InputError("the run record does not fit the scene: " + what, seen, allowed, file);
}

void check_fields(const RunRecord& record, std::initializer_list<RecordField> fields,
                  const std::string& file) {
  for (const auto& [name, rows] : fields) {
    const auto found = record.snapshots.find(name);
    if (found == record.snapshots.end())
      refuse_record(name, "no snapshots", "snapshots of every field", file);
    const auto& values = found->second.values;
    if (values.rows() != static_cast<Eigen::Index>(rows))
      refuse_record(name, std::to_string(values.rows()) + " rows", std::to_string(rows), file);
    if (!values.allFinite()) refuse_record(name, "nan or inf", "finite numbers", file);
  }
}

} // namespace undula::training
