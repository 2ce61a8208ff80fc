#include "fom/system/handles.hpp"

#include <string>

#include "rom/base/error.hpp"

namespace undula::fom {

void check_petsc(PetscErrorCode code, const char* what) {
  if (code == 0) return;
  const char* text = nullptr;
  PetscErrorMessage(code, &text, nullptr);
  throw NumericsError(std::string(what) + " failed in PETSc (code " + std::to_string(code) + ")",
                      text ? text : "no text",
                      "run with -malloc_debug -info; check the options given to PETSc");
}

} // namespace undula::fom
