#include "fom/root_rank.hpp"

#include <exception>

#include "base/error.hpp"

namespace undula {

void on_root(MPI_Comm comm, const std::function<void()>& task) {
  enum Outcome { done, input_is_wrong, numerics_failed };
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  int outcome = done;
  std::exception_ptr error;
  if (rank == 0) {
    try {
      task();
    } catch (const InputError&) {
      error = std::current_exception();
      outcome = input_is_wrong;
    } catch (...) {
      error = std::current_exception();
      outcome = numerics_failed;
    }
  }
  MPI_Bcast(&outcome, 1, MPI_INT, 0, comm);
  if (error) std::rethrow_exception(error);
  if (outcome == input_is_wrong)
    throw InputError("rank 0 refused its input", "see its message", "see its message", "rank 0");
  if (outcome == numerics_failed) throw NumericsError("rank 0 failed", "see its message", "see its message");
}

void broadcast_state(MPI_Comm comm, State& state) {
  MPI_Bcast(&state.step, 1, MPI_INT, 0, comm);
  MPI_Bcast(&state.time, 1, MPI_DOUBLE, 0, comm);
  for (auto* levels : {&state.x, &state.d})
    for (auto& level : *levels) MPI_Bcast(level.data(), static_cast<int>(level.size()), MPI_DOUBLE, 0, comm);
}

} // namespace undula
