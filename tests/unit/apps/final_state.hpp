// The state that a run of undula solve ended in.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/apps.hpp"
#include "fom/output/checkpoint.hpp"
#include "rom/base/hdf5_file.hpp"

namespace undula::apps {

/// All time levels of the newest checkpoint in an output folder, one after the other.
inline std::vector<double> final_state(const std::filesystem::path& folder) {
  const auto file = Hdf5File::open_read(newest_checkpoint(folder / "checkpoints").value());
  std::vector<double> all;
  for (const char* name : {"x_0", "x_1", "d_0", "d_1"}) {
    const auto values = file.read<double>(std::string("arrays/") + name);
    all.insert(all.end(), values.begin(), values.end());
  }
  return all;
}

} // namespace undula::apps
