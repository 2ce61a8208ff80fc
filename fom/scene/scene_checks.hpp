// Checks that involve several keys of a scene.
#pragma once

#include <string>

#include "fom/scene/scene.hpp"

namespace undula::fom {

/// Throws InputError naming the keys that contradict each other; `where` names the scene in the message.
/// The plan of a training is left out: other commands than train do not use it.
void check_consistency(const Scene& scene, const std::string& where);

/// The same for section [training] of a pump: for what trains, and for what checks scenes that state it.
void check_training(const Scene& scene, const std::string& where);

} // namespace undula::fom
