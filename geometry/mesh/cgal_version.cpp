#include "geometry/mesh/cgal_version.hpp"

#include <CGAL/version.h>

namespace undula::geometry {

std::string cgal_version() { return CGAL_VERSION_STR; }

} // namespace undula::geometry
