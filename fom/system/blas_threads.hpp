// Threads of the linear algebra below the direct solver.
#pragma once

namespace undula::fom {

/// Keeps OpenBLAS, where it is the BLAS in use, to one thread per process: the fronts of our factorisations
/// are small, and threads of several ranks on the same cores cost a factor of two and more.
void use_one_blas_thread();

} // namespace undula::fom
