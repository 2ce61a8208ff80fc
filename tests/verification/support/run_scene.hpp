// Runs a scene file as `undula solve` does and keeps its time series.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "fom/levels/march.hpp"
#include "fom/output/series_statistics.hpp"
#include "fom/scene/scene_file.hpp"
#include "tests/verification/support/names.hpp"

namespace undula::verification {

struct SceneRun {
  Scene scene;
  TimeSeries table;
  int unknowns = 0;

  /// Column of the table by its name.
  std::vector<double> column(const std::string& name) const {
    const auto found = std::find(table.columns.begin(), table.columns.end(), name);
    EXPECT_NE(found, table.columns.end()) << "no column " << name;
    std::vector<double> values;
    for (std::size_t row = 0; row < table.rows() && found != table.columns.end(); ++row)
      values.push_back(table.value(row, static_cast<std::size_t>(found - table.columns.begin())));
    return values;
  }
  double last(const std::string& name) const { return column(name).at(table.rows() - 1); }
};

/// `name` of a scene in data/scenes.
inline SceneRun run_scene(const std::string& name, std::vector<std::string> settings) {
  SceneRun run;
  // A run that is cut short may end before the scene's window of statistics, which is not looked at here.
  if (std::any_of(settings.begin(), settings.end(),
                  [](const std::string& text) { return text.starts_with("time.end_s="); }))
    settings.emplace_back("output.statistics_from_s=0");
  run.scene = read_scene(UNDULA_SOURCE_DIR "/data/scenes/" + name + ".toml", settings);
  PhaseTimer timer;
  const auto level = prepare_level(run.scene, MPI_COMM_SELF, timer);
  run.unknowns = level->unknowns();
  const RowLayout rows = level->view(run.scene).rows;
  run.table.columns = observation_columns(rows);
  State state = level->initial_state();
  march(*level, run.scene, state, timer, [&](const State& now, const Observation& seen) {
    run.table.steps.push_back(now.step);
    const auto row = observation_row(seen, rows);
    run.table.values.insert(run.table.values.end(), row.begin(), row.end());
  });
  return run;
}

} // namespace undula::verification
