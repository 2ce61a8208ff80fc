// What `train` says of a model of a moving domain that it has made.
#pragma once

#include <string>

#include "training/moving_domain/build_moving_model.hpp"

namespace undula::apps {

/// Modes, elements, and the held-out runs beside what the model makes of them. `file`: where it was written.
std::string moving_model_text(const training::BuiltMovingModel& built, const std::string& file);

/// The same as JSON.
std::string moving_model_json(const training::BuiltMovingModel& built, const std::string& file);

} // namespace undula::apps
