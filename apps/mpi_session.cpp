#include "apps/mpi_session.hpp"

#include <slepcsys.h>
#include <spdlog/spdlog.h>

#include <CLI/Error.hpp>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <sstream>
#include <string_view>

#include "apps/apps.hpp"
#include "fom/output/provenance.hpp"
#include "fom/system/blas_threads.hpp"
#include "fom/system/handles.hpp"
#include "rom/base/error.hpp"

namespace undula::apps {
namespace {

class Session {
public:
  explicit Session(const std::vector<std::string>& petsc_options) : words_{"undula"} {
    words_.insert(words_.end(), petsc_options.begin(), petsc_options.end());
    for (auto& word : words_) {
      arguments_.push_back(word.data());
    }
    use_one_blas_thread();
    int count = static_cast<int>(arguments_.size());
    arguments_.push_back(nullptr);
    char** arguments = arguments_.data();
    check_petsc(SlepcInitialize(&count, &arguments, nullptr, nullptr), "starting PETSc and SLEPc");
    // Failures surface as exceptions, and signals end the process as they would without PETSc.
    PetscPopSignalHandler();
    PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  ~Session() { SlepcFinalize(); }

  /// Options that the command line does not name: from .petscrc, petscrc or PETSC_OPTIONS.
  [[nodiscard]] std::string foreign_options() const {
    std::istringstream all(petsc_options_in_force());
    std::string foreign;
    for (std::string word; all >> word;) {
      if (std::find(words_.begin(), words_.end(), word) == words_.end()) {
        foreign += (foreign.empty() ? "" : " ") + word;
      }
    }
    return foreign;
  }

private:
  std::vector<std::string> words_; // PETSc keeps pointers into them
  std::vector<char*> arguments_;
};

/// Misspelt ones among them.
void warn_of_unused_options() {
  PetscInt count = 0;
  char **names = nullptr, **values = nullptr;
  check_petsc(PetscOptionsLeftGet(nullptr, &count, &names, &values), "asking for unused options");
  std::string unused;
  for (PetscInt i = 0; i < count; ++i) {
    // Read before PETSc counts, or while it ends.
    constexpr std::array others = {"skip_petscrc", "options_left",   "options_view", "malloc_dump",
                                   "malloc_view",  "memory_view",    "log_view",     "objects_dump",
                                   "mpidump",      "log_view_memory"};
    if (std::find(others.begin(), others.end(), std::string_view(names[i])) == others.end()) {
      unused += std::string(unused.empty() ? "" : " ") + "-" + names[i];
    }
  }
  check_petsc(PetscOptionsLeftRestore(nullptr, &count, &names, &values), "asking for unused options");
  if (!unused.empty()) {
    spdlog::warn("nothing asked for these PETSc options: {}; those of the solver begin with -fsi_", unused);
  }
}

} // namespace

bool is_first_process() {
  for (const char* variable : {"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK"}) {
    if (const char* rank = std::getenv(variable)) {
      return std::string_view(rank) == "0";
    }
  }
  return true;
}

void run_alone(const std::vector<std::string>& petsc_options, const std::function<void(MPI_Comm)>& work) {
  if (!petsc_options.empty()) {
    throw InputError("options for PETSc do not go with a reduced model", '"' + petsc_options.front() + '"',
                     "options for PETSc after -- with a scene (.toml)", "the command line");
  }
  if (is_first_process()) {
    work(MPI_COMM_NULL);
  }
}

void run_parallel(const std::vector<std::string>& petsc_options, const std::function<void(MPI_Comm)>& work) {
  if (!petsc_options.empty() && !petsc_options.front().starts_with('-')) {
    throw InputError("an argument too many", '"' + petsc_options.front() + '"',
                     "options for PETSc after --, for instance -- -log_view", "the command line");
  }
  const Session session(petsc_options);
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (rank == 0) {
    if (const std::string foreign = session.foreign_options(); !foreign.empty()) {
      spdlog::warn(
          "PETSc options that the command line does not name are in force (from .petscrc, petscrc or "
          "PETSC_OPTIONS): {}; -skip_petscrc after -- leaves the files out",
          foreign);
    }
    work(PETSC_COMM_WORLD);
    warn_of_unused_options();
    return;
  }
  spdlog::set_level(spdlog::level::off);
  try {
    work(PETSC_COMM_WORLD);
  } catch (const InputError&) {
    throw CLI::RuntimeError(2);
  } catch (const std::exception&) {
    throw CLI::RuntimeError(1);
  }
}

} // namespace undula::apps
