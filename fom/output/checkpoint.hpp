// State of a run on disk, from which it goes on bit for bit.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
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

/// Writes `folder`/checkpoint_<step>.h5 (the folder is created) in one step and after that removes all but
/// the last two checkpoints: the older one stands in where the newest turns out to be damaged. Call on one
/// rank. Returns the file.
std::filesystem::path save_checkpoint(const Checkpoint& state, const std::filesystem::path& folder);

/// Reads a checkpoint of the scene with this stamp. Throws InputError for a missing, damaged or foreign file
/// and for another scene's, naming both hashes.
Checkpoint load_checkpoint(const std::filesystem::path& file, const SceneStamp& scene);

/// A checkpoint as it lies in its folder.
struct StoredCheckpoint {
  int step = 0; ///< in its name
  std::filesystem::path file;
};

/// The checkpoints of a folder, newest first; none where there is no such folder.
std::vector<StoredCheckpoint> stored_checkpoints(const std::filesystem::path& folder);

/// Step in the name of a checkpoint, -1 for other names.
int checkpoint_step(std::string_view name);

/// The checkpoint of the highest step in a folder, if there is any.
std::optional<std::filesystem::path> newest_checkpoint(const std::filesystem::path& folder);

} // namespace undula::fom
