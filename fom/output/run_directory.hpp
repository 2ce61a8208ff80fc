// Everything a run leaves on disk:
//   scene_resolved.toml   the scene in force; its first line ties the folder to the scene
//   time_series.csv       one row per step, see step_table.hpp
//   statistics.csv        of scenes that state their problem: last value, mean, amplitude and frequency of
//   every
//                         column; such scenes have none of the next three files
//   membrane.csv          axial displacement of the membrane at its probes, one row per step
//   cycle_means.csv       mean, lowest and highest of every column of time_series.csv, one row per period
//   envelope.csv          radius_mm, low_mm, high_mm: reach of the membrane over the last complete period
//   fluid.xdmf, solids.xdmf and their HDF5 files, every output.fields_every steps
//   checkpoints/          every output.checkpoint_every steps, at the end, and where the numerics failed
//   timing.json           seconds per phase of the process that ended last
// A kill at any moment leaves all of it readable, and the run can go on from its newest checkpoint.
#pragma once

#include <filesystem>
#include <optional>

#include "fom/output/checkpoint.hpp"
#include "fom/output/level_view.hpp"
#include "fom/output/step_table.hpp"
#include "fom/scene/scene.hpp"
#include "rom/base/phase_timer.hpp"

namespace undula::fom {

/// What to do with a folder that holds a run already.
enum class ExistingRun { refuse, go_on, replace };

/// Throws InputError if the checkpoints of the scene would not fall on fresh factorisations, after which
/// alone a restart repeats the run bit for bit.
void check_checkpoint_interval(const Scene& scene);

/// Throws InputError, naming the scene that is there, if the folder must not be used for this one: it holds a
/// run and `existing` is refuse, or it holds the run of another scene and `existing` is go_on. Changes
/// nothing.
void check_run_directory(const std::filesystem::path& folder, const Scene& scene, ExistingRun existing);

/// For one rank. Errors: InputError for a folder that is refused or not writable, NumericsError when the disk
/// is full.
class RunDirectory {
public:
  /// Makes the folder ready. `state` comes at rest, in the sizes of the level. With go_on it becomes that of
  /// the newest checkpoint, if there is one, and what was written after it is dropped; otherwise it is left
  /// as it is. `scene` has to outlive the object.
  RunDirectory(std::filesystem::path folder, LevelView view, const Scene& scene, ExistingRun existing,
               int ranks, State& state);

  /// Adds a step: rows, fields and checkpoint as far as they are due, summaries at the end of a period.
  void record(const State& state, const Observation& seen);

  /// Writes a checkpoint now, unless the step has one. Returns its file.
  std::filesystem::path save_state(const State& state);

  /// Ends the run: last checkpoint, timing.
  void finish(const State& state, const PhaseTimer& timer);

  const std::filesystem::path& folder() const { return folder_; }
  const LevelView& view() const { return view_; }
  const TimeSeries& series() const { return series_->table(); }
  const TimeSeries& membrane() const {
    return membrane_->table();
  } ///< cm -> mm, one column per probe; pumps only

private:
  void write_summaries() const;

  std::filesystem::path folder_;
  LevelView view_;
  const Scene& scene_;
  SceneStamp stamp_;
  std::map<std::string, std::string> provenance_;
  int saved_step_ = -1;
  std::optional<TimeSeriesFile> series_, membrane_;
  std::optional<FieldWriter<2>> fluid_writer_, solid_writer_;
};

} // namespace undula::fom
