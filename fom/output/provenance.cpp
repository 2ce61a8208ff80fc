#include "fom/output/provenance.hpp"

#include <petscsys.h>

#include "undula_build.hpp" // made by git_commit.cmake at every build

namespace undula::fom {

std::string petsc_options_in_force() {
  PetscBool started = PETSC_FALSE;
  char* text = nullptr;
  if (PetscInitialized(&started) != 0 || started == PETSC_FALSE) return "";
  if (PetscOptionsGetAll(nullptr, &text) != 0 || text == nullptr) return "";
  std::string options = text;
  (void)PetscFree(text);
  while (!options.empty() && options.back() == ' ') options.pop_back();
  return options;
}

std::map<std::string, std::string> provenance(int ranks) {
  return {{"version", build_version},
          {"commit", build_commit},
          {"ranks", std::to_string(ranks)},
          {"petsc_options", petsc_options_in_force()}};
}

} // namespace undula::fom
