// Model files as commands take them.
#pragma once

#include <string>

#include "rom/fixed_domain/model.hpp"

namespace undula::apps {

/// rom::load_model, with a warning for a file of an older version that carries no seal.
rom::Model read_model(const std::string& file);

} // namespace undula::apps
