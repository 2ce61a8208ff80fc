// The pictures of a full-order run.
#pragma once

#include <filesystem>

#include "apps/apps.hpp"
#include "fom/output/level_view.hpp"
#include "fom/output/run_directory.hpp"
#include "fom/output/time_series.hpp"

namespace undula::apps {

/// What pictures of a run are drawn from: of a run that just ended, or of one on disk
/// (fom/output/finished_run.hpp).
struct DrawnRun {
  std::filesystem::path folder; ///< of the pictures
  const LevelView& view;
  const TimeSeries& series;
  const TimeSeries* membrane;     ///< nullptr: no membrane
  std::vector<double> wall_shear; ///< dyn/cm^2, mean of the last whole period by wall element; empty: none
};

DrawnRun drawn_run(const RunDirectory& run);

/// Draws into its folder: speed.png and pressure.png (the state, with the displaced solids),
/// speed_gap.png (the same near the membrane), membrane.png (at eight phases of the last complete period) and
/// flow.png (over time), holder.png (where a voltage drives it); of a scene that states its problem the first
/// three, where it has a fluid, and stress.png (von Mises' stress on the displaced solids). Without gnuplot
/// there is a warning and the scripts are kept.
void plot_run(const DrawnRun& run, const Scene& scene, const State& state);

} // namespace undula::apps
