// Scenes to begin with, and the profile that one of them names: files of data/, as they were when the program
// was built.
#pragma once

#include <string_view>

namespace undula::apps {

std::string_view wave_pump_template();        ///< data/scenes/wave_pump_thin_gap.toml
std::string_view wave_pump_profile();         ///< data/profiles/wave_pump_profile.toml
std::string_view peristaltic_pump_template(); ///< data/scenes/peristaltic_pump.toml
std::string_view general_template();          ///< data/scenes/flap_in_channel.toml

} // namespace undula::apps
