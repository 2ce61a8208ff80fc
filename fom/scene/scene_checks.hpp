// Checks that involve several keys of a scene.
#pragma once

#include <string>

#include "fom/scene/scene.hpp"

namespace undula::fom {

/// Throws InputError naming the keys that contradict each other; `where` names the scene in the message.
void check_consistency(const Scene& scene, const std::string& where);

} // namespace undula::fom
