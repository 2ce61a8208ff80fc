#include "fom/output/provenance.hpp"

#include "undula_build.hpp" // made by git_commit.cmake at every build

namespace undula::fom {

std::map<std::string, std::string> provenance(int ranks) {
  return {{"version", build_version}, {"commit", build_commit}, {"ranks", std::to_string(ranks)}};
}

} // namespace undula::fom
