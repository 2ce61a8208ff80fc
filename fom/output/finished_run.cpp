#include "fom/output/finished_run.hpp"

#include <charconv>
#include <sstream>

#include "fom/output/checkpoint.hpp"
#include "fom/output/run_directory.hpp"
#include "fom/output/run_files.hpp"
#include "fom/output/state_file.hpp"
#include "fom/scene/scene_file.hpp"
#include "rom/base/error.hpp"
#include "rom/base/file_format.hpp"
#include "rom/base/text_file.hpp"

namespace undula::fom {
namespace {

constexpr std::size_t mean_column = 4; // of wall_shear.csv: period,r,z,length,mean,max

/// What write_wall_shear() wrote.
std::vector<double> read_mean_shear(const std::filesystem::path& file, std::size_t walls) {
  std::istringstream rows(read_text_file(file));
  std::vector<double> means;
  std::string row, cell;
  std::getline(rows, row); // names
  while (std::getline(rows, row)) {
    std::istringstream cells(row);
    for (std::size_t k = 0; k <= mean_column; ++k) std::getline(cells, cell, ',');
    double mean = 0;
    const auto read = std::from_chars(cell.data(), cell.data() + cell.size(), mean);
    if (read.ec != std::errc() || read.ptr != cell.data() + cell.size())
      throw InputError("a table of wall shear is damaged", '"' + row + '"', "six numbers a line",
                       file.string());
    means.push_back(mean);
  }
  if (means.size() != walls)
    throw InputError("a table of wall shear does not fit the walls of the run",
                     std::to_string(means.size()) + " lines",
                     std::to_string(walls) + ", one for each wall element", file.string());
  return means;
}

} // namespace

Scene read_run_scene(const std::filesystem::path& folder, const std::vector<std::string>& overrides) {
  const auto file = folder / resolved_scene_name;
  if (!std::filesystem::is_regular_file(file))
    throw InputError("the folder holds no run", "no " + std::string(resolved_scene_name),
                     "a folder that `undula solve` wrote", folder.string());
  Scene scene = read_scene(file, overrides);
  check_run_directory(folder, scene, ExistingRun::go_on);
  return scene;
}

FinishedRun read_finished_run(const std::filesystem::path& folder, const Scene& scene, const LevelView& view,
                              const State& like) {
  FinishedRun run;
  const auto stamp = stamp_scene(scene);
  const auto checkpoints = stored_checkpoints(checkpoint_folder(folder));
  bool found = false;
  for (auto stored = checkpoints.begin(); stored != checkpoints.end() && !found; ++stored) {
    try {
      run.state = state_of(load_checkpoint(stored->file, stamp), like, stored->file);
      found = true;
    } catch (const LaterFormatError&) {
      throw;
    } catch (const InputError& error) {
      run.damaged.emplace_back(error.what());
    }
  }
  if (!found) {
    std::string reasons;
    for (const auto& message : run.damaged) reasons += "\n" + message;
    throw InputError("the run has no state to draw" + reasons,
                     std::to_string(checkpoints.size()) + " checkpoints", "one whole checkpoint",
                     checkpoint_folder(folder).string());
  }
  run.series = read_whole_rows(folder / "time_series.csv");
  if (!view.probes.radius.empty()) run.membrane = read_whole_rows(folder / "membrane.csv");
  if (const auto file = folder / "wall_shear.csv"; !view.walls.empty() && std::filesystem::exists(file))
    run.wall_shear = read_mean_shear(file, view.walls.size());
  return run;
}

} // namespace undula::fom
