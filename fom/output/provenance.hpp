// Which program made a file.
#pragma once

#include <map>
#include <string>

namespace undula::fom {

/// "version" of Undula, git "commit" it was built from (with "-dirty" for uncommitted changes, "unknown"
/// outside a checkout), number of MPI "ranks", "petsc_options" in force. Recorded in every HDF5 file.
std::map<std::string, std::string> provenance(int ranks);

/// All options that PETSc holds, from the command line, options files and the environment; "" before it is
/// started.
std::string petsc_options_in_force();

} // namespace undula::fom
