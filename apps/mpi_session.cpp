#include "apps/mpi_session.hpp"

#include <slepcsys.h>
#include <spdlog/spdlog.h>

#include <CLI/Error.hpp>

#include "apps/apps.hpp"
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

private:
  std::vector<std::string> words_; // PETSc keeps pointers into them
  std::vector<char*> arguments_;
};

} // namespace

void run_parallel(const std::vector<std::string>& petsc_options, const std::function<void(MPI_Comm)>& work) {
  if (!petsc_options.empty() && !petsc_options.front().starts_with('-')) {
    throw InputError("an argument too many", '"' + petsc_options.front() + '"',
                     "options for PETSc after --, for instance -- -log_view", "the command line");
  }
  const Session session(petsc_options);
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (rank == 0) {
    work(PETSC_COMM_WORLD);
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
