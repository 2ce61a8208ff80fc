// State of a run on disk, from which it goes on bit for bit.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fom/output/scene_stamp.hpp"

namespace undula::fom {

/// All time levels in use, in a numbering that does not depend on the number of ranks. Names without "/".
struct Checkpoint {
  int step = 0;                                      ///< last completed step
  double time = 0;                                   ///< s
  std::map<std::string, double> scalars;             ///< further state by name, cgs
  std::map<std::string, std::vector<double>> arrays; ///< by name, e.g. "velocity_old"; cgs
  SceneStamp scene;
  std::map<std::string, std::string> provenance; ///< version, commit, ranks
};

/// Writes `folder`/checkpoint_<step>.h5 (the folder is created) in one step, then removes all but the last
/// two checkpoints and what killed runs left behind. Call on one rank. Returns the file.
std::filesystem::path save_checkpoint(const Checkpoint& state, const std::filesystem::path& folder);

/// Reads a checkpoint of the scene with this stamp. Throws InputError for a missing, truncated or foreign
/// file and, naming both, for another scene's.
Checkpoint load_checkpoint(const std::filesystem::path& file, const SceneStamp& scene);

/// The checkpoint of the highest step in a folder, if there is any.
std::optional<std::filesystem::path> newest_checkpoint(const std::filesystem::path& folder);

} // namespace undula::fom
