// Which files of a folder belong to a run: what may be replaced, and what is somebody else's.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace undula::fom {

/// The scene in force; its first line is the stamp that makes a folder one of Undula's.
inline constexpr const char* resolved_scene_name = "scene_resolved.toml";

/// Whether a run, or a picture of it, writes a file of this name into its folder. Checkpoints lie in a folder
/// of their own, see checkpoint_step(). Names of files on their way (*.partial) count as their targets do.
bool is_run_file(std::string_view name);

/// Folder of the checkpoints of a run.
std::filesystem::path checkpoint_folder(const std::filesystem::path& run);

/// The files in `folder` that is_run_file() names, checkpoints included, in the order in which a run may be
/// removed: what a restart relies on first, the stamp last.
std::vector<std::filesystem::path> run_files(const std::filesystem::path& folder);

/// Removes all files of a run, or none: throws InputError, before anything is removed, where one of the names
/// is a folder or the folder is not writable. Other files stay.
void remove_run(const std::filesystem::path& folder);

/// Removes what killed processes left half-written. The caller holds the folder's lock.
void remove_unfinished(const std::filesystem::path& folder);

} // namespace undula::fom
