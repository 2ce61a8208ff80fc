// For what is recorded about a build.
#pragma once

#include <string>

namespace undula::geometry {

/// "5.5.1".
std::string cgal_version();

} // namespace undula::geometry
