// The pictures of a full-order run.
#pragma once

#include <filesystem>

#include "apps/apps.hpp"
#include "fom/output/run_directory.hpp"

namespace undula::apps {

/// Draws into the folder of the run: speed.png and pressure.png (the state, with the displaced solids),
/// speed_gap.png (the same near the membrane), membrane.png (at eight phases of the last complete period) and
/// flow.png (over time), holder.png (where a voltage drives it); of a scene that states its problem the first
/// three, where it has a fluid, and stress.png (von Mises' stress on the displaced solids). Without gnuplot
/// there is a warning and the scripts are kept.
void plot_run(const RunDirectory& run, const Scene& scene, const State& state);

} // namespace undula::apps
