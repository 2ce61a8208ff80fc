// What the files of all models have in common: where they come from.
#pragma once

#include <map>
#include <string>

#include "rom/base/hdf5_file.hpp"

namespace undula {

/// A text per key, in the group "provenance". Keys must not contain '/'.
void write_provenance(Hdf5File& file, const std::map<std::string, std::string>& provenance);
std::map<std::string, std::string> read_provenance(const Hdf5File& file);

} // namespace undula
