// Everything a run leaves on disk:
//   scene_resolved.toml   the scene in force; its first line ties the folder to the scene
//   time_series.csv       one row per step, see step_table.hpp
//   statistics.csv        of scenes that state their problem: last value, mean, amplitude and frequency of
//   every
//                         column; such scenes have none of the next three files
//   membrane.csv          axial displacement of the membrane at its probes, one row per step; not of a
//   peristaltic pump, nor envelope.csv
//   cycle_means.csv       mean, lowest and highest of every column of time_series.csv, one row per period
//   envelope.csv          radius_mm, low_mm, high_mm: reach of the membrane over the last complete period
//   wall_shear.csv        mean and greatest shear of every wall element over the last complete period
//   fluid.xdmf, solids.xdmf and their HDF5 files, every output.fields_every steps
//   checkpoints/          the last two: as output.checkpoint_every says, at the end, on a signal, and where
//   the
//                         numerics failed
//   timing.json           seconds per phase of the process that ended last
// A kill at any moment leaves all of it readable, and the run can go on from its newest checkpoint. While a
// process writes, it holds the folder's lock (folder_lock.hpp); run_files.hpp knows the names.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>

#include "fom/output/checkpoint.hpp"
#include "fom/output/level_view.hpp"
#include "fom/output/step_table.hpp"
#include "fom/output/wall_shear_map.hpp"
#include "fom/scene/scene.hpp"
#include "rom/base/phase_timer.hpp"

namespace undula::fom {

/// What to do with a folder that holds a run already.
enum class ExistingRun { refuse, go_on, replace };

/// Throws InputError if the checkpoints of the scene would not fall on fresh factorisations, after which
/// alone a restart repeats the run bit for bit.
void check_checkpoint_interval(const Scene& scene);

/// Whether a run writes a checkpoint after `step`, the last one being that of `saved_step` (0: none),
/// `seconds` ago. output.checkpoint_every steps; automatic_checkpoints: at the end of every period of a pump,
/// and in any case a minute after the last one. Only steps after which the matrix is factored anew count.
bool checkpoint_due(const Scene& scene, int step, int saved_step, double seconds);

/// Throws InputError if the folder must not be used for this scene: it holds a run and `existing` is refuse;
/// it holds the run of another scene (the keys that differ are named), or one that is longer than the scene,
/// and `existing` is go_on; it holds files with the names of a run's, but no run that Undula stamped; it is a
/// campaign's. Changes nothing.
void check_run_directory(const std::filesystem::path& folder, const Scene& scene, ExistingRun existing);

/// Gives a scene that leaves its reference velocity to be derived the one of the run in the folder, if there
/// is a run: prolonged beyond what the velocity was derived from, it goes on with the same weights.
void keep_reference_velocity(const std::filesystem::path& folder, Scene& scene);

/// For one rank, which holds the FolderLock. Errors: InputError for a folder that is refused or not writable,
/// NumericsError when the disk is full.
class RunDirectory {
public:
  /// Makes the folder ready. `state` comes at rest, in the sizes of the level. With go_on it becomes that of
  /// the newest checkpoint that is whole and that the tables reach, if there is any checkpoint at all, and
  /// what was written after it is dropped; otherwise it is left as it is. With replace all files of the old
  /// run go. `scene` has to outlive the object.
  RunDirectory(std::filesystem::path folder, LevelView view, const Scene& scene, ExistingRun existing,
               int ranks, State& state);

  /// Adds a step: rows, fields and checkpoint as far as they are due, summaries at the end of a period.
  void record(const State& state, const Observation& seen);

  /// Whether the tables end with this step.
  bool has_row_of(int step) const { return series().rows() > 0 && series().steps.back() == step; }

  /// Writes a checkpoint now, unless the step has one. Returns its file.
  std::filesystem::path save_state(const State& state);

  /// Ends the run: last checkpoint, timing.
  void finish(const State& state, const PhaseTimer& timer);

  /// Messages about checkpoints that could not be used, newest first; an older one stood in for them.
  const std::vector<std::string>& damaged() const { return damaged_; }

  const std::filesystem::path& folder() const { return folder_; }
  const LevelView& view() const { return view_; }
  const WallShearMap& wall_shear() const { return wall_shear_; }
  const TimeSeries& series() const { return series_->table(); }
  const TimeSeries& membrane() const {
    return membrane_->table();
  } ///< cm -> mm, one column per probe; pumps with a membrane only

private:
  void go_on_from_checkpoint(State& state);
  void saved(int step, std::filesystem::path file);
  void write_summaries() const;

  std::filesystem::path folder_;
  LevelView view_;
  const Scene& scene_;
  SceneStamp stamp_;
  std::map<std::string, std::string> provenance_;
  int saved_step_ = 0; ///< of the newest good checkpoint; 0: none
  std::filesystem::path saved_file_;
  std::chrono::steady_clock::time_point saved_at_ = std::chrono::steady_clock::now();
  std::vector<std::string> damaged_;
  std::optional<TimeSeriesFile> series_, membrane_;
  std::optional<FieldWriter<2>> fluid_writer_, solid_writer_;
  WallShearMap wall_shear_;
};

} // namespace undula::fom
