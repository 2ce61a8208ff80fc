// Checks that involve several keys of a scene.
#pragma once

#include <string>

#include "fom/scene/scene.hpp"

namespace undula::fom {

/// Throws InputError naming the keys that contradict each other; `where` names the scene in the message.
void check_consistency(const Scene& scene, const std::string& where);

/// The same for the keys of [training], which campaigns alone use.
void check_training(const Scene& scene, const std::string& where);

/// Whether the scene states a key of [training] itself.
bool states_training(const Scene& scene);

} // namespace undula::fom
