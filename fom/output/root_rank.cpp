#include "fom/output/root_rank.hpp"

#include <exception>

#include "rom/base/error.hpp"

namespace undula::fom {

void on_root(MPI_Comm comm, const std::function<void()>& task) {
  if (comm == MPI_COMM_NULL) return task();
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
  MPI_Bcast(&state.last_step, 1, MPI_DOUBLE, 0, comm);
  const auto broadcast = [&](Eigen::VectorXd& values) {
    auto size = static_cast<long long>(values.size());
    MPI_Bcast(&size, 1, MPI_LONG_LONG, 0, comm);
    values.resize(size);
    MPI_Bcast(values.data(), static_cast<int>(size), MPI_DOUBLE, 0, comm);
  };
  for (auto* levels : {&state.x, &state.d, &state.map})
    for (auto& level : *levels) broadcast(level);
  broadcast(state.placement);
}

} // namespace undula::fom
