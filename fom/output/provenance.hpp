// Which program made a file.
#pragma once

#include <map>
#include <string>

namespace undula::fom {

/// "version" of Undula, git "commit" it was built from (with "-dirty" for uncommitted changes, "unknown"
/// outside a checkout), number of MPI "ranks". Recorded in every HDF5 file.
std::map<std::string, std::string> provenance(int ranks);

} // namespace undula::fom
