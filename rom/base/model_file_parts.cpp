#include "rom/base/model_file_parts.hpp"

namespace undula {

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
