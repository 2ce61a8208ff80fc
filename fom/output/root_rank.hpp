// Work that one rank does for all: files, and the state read from them.
#pragma once

#include <mpi.h>

#include <functional>

#include "fom/time/time_stepper.hpp"

namespace undula::fom {

/// Runs `task` on rank 0. If it throws, every rank throws: rank 0 the same exception, the others one of the
/// same kind (InputError, else NumericsError) that refers to it. A process without MPI, which has
/// MPI_COMM_NULL for a communicator, is its own root. Collective.
void on_root(MPI_Comm comm, const std::function<void()>& task);

/// Copies the state of rank 0 to every rank, where the vectors have the same sizes. Collective.
void broadcast_state(MPI_Comm comm, State& state);

} // namespace undula::fom
