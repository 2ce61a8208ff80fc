// What a user has to know before believing a peristaltic pump of the fast level.
#pragma once

#include <string>
#include <vector>

#include "fom/scene/scene.hpp"

namespace undula::fom {

/// Where the scene leaves the range of the closed forms, a sentence each.
std::vector<std::string> hose_remarks(const Scene& scene);

} // namespace undula::fom
