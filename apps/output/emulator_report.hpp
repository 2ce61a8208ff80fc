// What `train` says of an emulator it has made.
#pragma once

#include <string>

#include "training/emulation/build_emulator.hpp"

namespace undula::apps {

/// Every run with what the emulator says of it when it is left out, and the scores. `file`: where it was
/// written.
std::string emulator_text(const training::BuiltEmulator& built, const std::string& file);

/// The same as JSON.
std::string emulator_json(const training::BuiltEmulator& built, const std::string& file);

} // namespace undula::apps
