// The small scene of runs that are disturbed or looked at: tests/data/post_in_channel.toml.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/unit/apps/run_undula.hpp"

namespace undula::apps {

/// Writes it to `file`, ending at `end_s` (s) in place of 0.1, and returns the name.
inline std::string write_small_scene(const std::filesystem::path& file, const std::string& end_s = "0.1") {
  std::string text = text_of(UNDULA_SOURCE_DIR "/tests/data/post_in_channel.toml");
  const std::string key = "end_s = ";
  text.replace(text.find(key + "0.1") + key.size(), 3, end_s);
  std::ofstream(file) << text;
  return file.string();
}

} // namespace undula::apps
