// A run on disk, read to be looked at: nothing in its folder changes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fom/output/level_view.hpp"
#include "fom/output/time_series.hpp"
#include "fom/scene/scene.hpp"

namespace undula::fom {

/// The scene of the run in a folder that `undula solve` wrote, with overrides ("section.key=value"; of a
/// profile that has moved, for instance). Throws InputError for a folder without a run, and where the
/// overrides make it another scene.
Scene read_run_scene(const std::filesystem::path& folder, const std::vector<std::string>& overrides);

struct FinishedRun {
  State state;                    ///< of the newest checkpoint that is whole
  TimeSeries series, membrane;    ///< membrane: cm -> mm, no columns where there is none
  std::vector<double> wall_shear; ///< dyn/cm^2, mean over the last whole period by wall element; empty: none
  std::vector<std::string> damaged; ///< messages about newer checkpoints that could not be used
};

/// Reads the run of `scene`. `like`: a state in the sizes of its level. Throws InputError where there is no
/// whole checkpoint, or a table is missing or damaged.
FinishedRun read_finished_run(const std::filesystem::path& folder, const Scene& scene, const LevelView& view,
                              const State& like);

} // namespace undula::fom
