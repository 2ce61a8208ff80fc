// What the files of all models have in common: their kind, and where they come from.
#pragma once

#include <map>
#include <string>

#include "rom/base/hdf5_file.hpp"

namespace undula {

/// The kind that a file says it is of; "another program's" where it says none.
std::string kind_of(const Hdf5File& file);

/// Throws InputError, which begins with `refusal` ("not an emulator"), for a file of another kind.
void check_kind(const Hdf5File& file, const std::string& kind, const char* refusal);

/// A text per key, in the group "provenance". Keys must not contain '/'.
void write_provenance(Hdf5File& file, const std::map<std::string, std::string>& provenance);
std::map<std::string, std::string> read_provenance(const Hdf5File& file);

} // namespace undula
