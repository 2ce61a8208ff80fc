#include "rom/base/model_file_parts.hpp"

#include "rom/base/error.hpp"

namespace undula {

std::string kind_of(const Hdf5File& file) {
  return file.has_attribute("/", "kind") ? file.read_attribute<std::string>("/", "kind")
                                         : "another program's";
}

void check_kind(const Hdf5File& file, const std::string& kind, const char* refusal) {
  if (const auto seen = kind_of(file); seen != kind)
    throw InputError(refusal, "a file of kind '" + seen + "'", "kind '" + kind + "'", file.path().string());
}

void write_provenance(Hdf5File& file, const std::map<std::string, std::string>& provenance) {
  file.create_group("provenance");
  for (const auto& [key, text] : provenance) file.write_text("provenance/" + key, text);
}

std::map<std::string, std::string> read_provenance(const Hdf5File& file) {
  std::map<std::string, std::string> provenance;
  for (const auto& key : file.children("provenance")) provenance[key] = file.read_text("provenance/" + key);
  return provenance;
}

} // namespace undula
