// MPI, PETSc and SLEPc for the commands that need them, and for no longer than they do.
#pragma once

#include <mpi.h>

#include <functional>
#include <string>
#include <vector>

namespace undula::apps {

/// Whether this process is alone, or the first of those that mpirun started: the one that prints the answer
/// of a command that does not use MPI.
bool is_first_process();

/// Runs `work` with MPI_COMM_NULL, without starting MPI and PETSc, which take longer than a reduced model
/// needs for its curve; where mpirun started several processes, by the first alone. Throws InputError for
/// options: nothing would read them.
void run_alone(const std::vector<std::string>& petsc_options, const std::function<void(MPI_Comm)>& work);

/// Initialises MPI, PETSc and SLEPc with `petsc_options` ("-log_view", "-fsi_ksp_monitor", ...), runs `work`
/// on every rank and finalises. `work` has to fail on all ranks or on none; rank 0 then throws what it threw,
/// the others CLI::RuntimeError with the same exit code, so that a failure is told once. Logs of the other
/// ranks are off. Warns of options that come from files or the environment, and of those that nothing asked
/// for. Throws InputError if the options do not begin with a "-".
void run_parallel(const std::vector<std::string>& petsc_options, const std::function<void(MPI_Comm)>& work);

} // namespace undula::apps
