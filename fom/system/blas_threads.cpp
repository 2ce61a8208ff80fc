#include "fom/system/blas_threads.hpp"

#include <dlfcn.h>

namespace undula::fom {

void use_one_blas_thread() {
  // Looked up at run time, because other BLAS libraries do not have it.
  using SetThreads = void (*)(int);
  if (void* symbol = dlsym(RTLD_DEFAULT, "openblas_set_num_threads")) reinterpret_cast<SetThreads>(symbol)(1);
}

} // namespace undula::fom
