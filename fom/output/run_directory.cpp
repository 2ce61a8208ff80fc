#include "fom/output/run_directory.hpp"

#include <algorithm>
#include <charconv>
#include <limits>

#include "fom/output/provenance.hpp"
#include "fom/output/run_files.hpp"
#include "fom/output/scene_difference.hpp"
#include "fom/output/series_statistics.hpp"
#include "fom/output/state_file.hpp"
#include "fom/scene/scene_file.hpp"
#include "fom/scene/scene_time.hpp"
#include "rom/base/error.hpp"
#include "rom/base/file_format.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::fom {
namespace {

constexpr std::string_view stamp_prefix = "# undula run of the scene with hash ";

constexpr double seconds_between_checkpoints = 60;

/// The scene whose run a folder holds.
struct RunThere {
  std::string hash, name, text;
};

std::optional<RunThere> run_in(const std::filesystem::path& folder) {
  const auto file = folder / resolved_scene_name;
  if (!std::filesystem::exists(std::filesystem::symlink_status(file))) return std::nullopt;
  const std::string text = std::filesystem::is_regular_file(file) ? read_text_file(file) : "";
  if (!text.starts_with(stamp_prefix))
    throw InputError("the output folder holds a foreign scene", "no stamp in its first line",
                     "a folder that `undula solve` made, or a new one", file.string());
  RunThere there;
  there.hash = text.substr(stamp_prefix.size(), text.find('\n') - stamp_prefix.size());
  there.text = text;
  // The rest may name files that have moved since, so it is not parsed as a scene.
  constexpr std::string_view key = "\nname = \"";
  if (const auto begin = text.find(key); begin != std::string::npos)
    there.name = text.substr(begin + key.size(), text.find('"', begin + key.size()) - begin - key.size());
  return there;
}

/// Files that --force would have to take for its own, and could not know to be.
void refuse_foreign_files(const std::filesystem::path& folder) {
  for (const char* noun : {"campaign", "study"})
    if (const std::string stamp = std::string(noun) + ".h5"; std::filesystem::exists(folder / stamp))
      throw InputError(std::string("the output folder is that of a ") + noun, '"' + stamp + '"',
                       "a folder that `undula solve` made, or a new one", folder.string());
  const auto files = run_files(folder);
  if (files.empty()) return;
  throw InputError("the output folder holds files that no run of Undula can be shown to have written",
                   "\"" + files.front().lexically_proximate(folder).string() + "\"" +
                       (files.size() > 1 ? " and " + std::to_string(files.size() - 1) + " more" : "") +
                       ", but no stamped " + resolved_scene_name,
                   "another --output; or move these files away", folder.string());
}

/// The last step that a folder holds anything of.
int last_step_in(const std::filesystem::path& folder) {
  int last = 0;
  const auto checkpoints = stored_checkpoints(checkpoint_folder(folder));
  if (!checkpoints.empty()) last = checkpoints.front().step;
  try {
    const auto table = read_whole_rows(folder / "time_series.csv");
    if (table.rows() > 0) last = std::max(last, table.steps.back());
  } catch (const InputError&) {
    // A missing or damaged table is told of where it is needed.
  }
  return last;
}

std::vector<std::string> probe_columns(const MembraneProbes& probes) {
  std::vector<std::string> columns;
  for (const double radius : probes.radius)
    columns.push_back("displacement_mm_at_r_" + exact_number(units::length_to_mm(radius)) + "_mm");
  return columns;
}

} // namespace

void check_checkpoint_interval(const Scene& scene) {
  if (scene.output.checkpoint_every == automatic_checkpoints ||
      scene.output.checkpoint_every % scene.time.factor_every == 0)
    return;
  throw InputError("checkpoints do not fall on fresh factorisations, so a restart would not repeat the run",
                   "output.checkpoint_every = " + std::to_string(scene.output.checkpoint_every),
                   "a multiple of time.factor_every = " + std::to_string(scene.time.factor_every),
                   scene.file.string() + ", section [output]");
}

bool checkpoint_due(const Scene& scene, int step, int saved_step, double seconds) {
  const int every = scene.output.checkpoint_every;
  if (every != automatic_checkpoints) return every > 0 && step % every == 0;
  if (step % scene.time.factor_every != 0) return false;
  const int period = scene.problem.general ? 0 : scene.time.steps_per_period;
  const bool new_period = period > 0 && step / period > saved_step / period;
  return new_period || seconds >= seconds_between_checkpoints;
}

void keep_reference_velocity(const std::filesystem::path& folder, Scene& scene) {
  const std::string key = "stabilisation.reference_velocity_cm_per_s";
  if (!scene.problem.general || scene.places.contains(key) || !std::filesystem::is_directory(folder)) return;
  const auto there = run_in(folder);
  const std::string recorded = there ? recorded_value(there->text, key) : "";
  double velocity = 0; // cm/s, the unit of the key
  if (std::from_chars(recorded.data(), recorded.data() + recorded.size(), velocity).ec == std::errc())
    scene.stabilisation.reference_velocity = velocity;
}

void check_run_directory(const std::filesystem::path& folder, const Scene& scene, ExistingRun existing) {
  if (std::filesystem::exists(folder) && !std::filesystem::is_directory(folder))
    throw InputError("the output folder is a file", folder.string(), "a folder, or a name not yet taken",
                     "--output");
  const auto there = run_in(folder);
  if (!there) return refuse_foreign_files(folder);
  if (existing == ExistingRun::replace) return;
  const std::string hash = scene_hash(scene);
  std::string seen = "scene \"" + there->name + "\" with hash " + there->hash;
  if (there->hash != hash) seen += "; " + difference_text(there->text, scene);
  if (existing == ExistingRun::go_on && there->hash != hash)
    throw InputError(
        "the output folder holds the run of another scene", seen,
        "scene \"" + scene.name + "\" with hash " + hash + "; or a new folder, or --force to replace it",
        folder.string());
  if (existing == ExistingRun::refuse)
    throw InputError("the output folder holds a run already", seen,
                     std::string(there->hash == hash ? "--restart to go on with it, " : "") +
                         "another --output, or --force to replace it",
                     folder.string());
  const int last_there = last_step_in(folder), last_asked = last_step(scene);
  if (last_there > last_asked)
    throw InputError(
        "the run in the output folder is longer than the scene asks for",
        std::to_string(last_there) + " steps, " + exact_number(last_there * time_step(scene)) + " s",
        "at least that many (" + std::string(scene.problem.general ? "time.end_s" : "time.periods") +
            " asks for " + std::to_string(last_asked) + "); or a new folder, or --force to replace the run",
        folder.string());
}

RunDirectory::RunDirectory(std::filesystem::path folder, LevelView view, const Scene& scene,
                           ExistingRun existing, int ranks, State& state)
    : folder_(std::move(folder)),
      view_(std::move(view)),
      scene_(scene),
      stamp_(stamp_scene(scene)),
      provenance_(provenance(ranks)),
      wall_shear_(scene.time.steps_per_period) {
  check_run_directory(folder_, scene, existing);
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error)
    throw InputError("cannot create the output folder", error.message(), "a writable place",
                     folder_.string());

  // 1. The state to go on from.
  remove_unfinished(folder_);
  if (existing == ExistingRun::go_on)
    go_on_from_checkpoint(state);
  else
    remove_run(folder_);
  replace_text_file(folder_ / resolved_scene_name,
                    std::string(stamp_prefix) + stamp_.hash + "\n" + stamp_.text);

  // 2. Tables and fields: from the start, or as they were at that state.
  const auto table = [&](const char* name, std::vector<std::string> columns) {
    return state.step == 0 ? TimeSeriesFile::start(folder_ / name, std::move(columns))
                           : TimeSeriesFile::go_on(folder_ / name, std::move(columns), state.step);
  };
  series_.emplace(table("time_series.csv", observation_columns(view_.rows)));
  if (!view_.probes.radius.empty()) membrane_.emplace(table("membrane.csv", probe_columns(view_.probes)));
  if (scene_.output.fields_every == 0) return;
  auto origin = provenance_;
  origin["scene"] = stamp_.text;
  const auto writer = [&](const char* name, const FieldMesh<2>& mesh) {
    return state.step == 0 ? FieldWriter<2>::start(folder_, name, mesh, origin)
                           : FieldWriter<2>::go_on(folder_, name, mesh, origin, state.step);
  };
  fluid_writer_.emplace(writer("fluid", view_.fluid));
  solid_writer_.emplace(writer("solids", view_.solids));
}

void RunDirectory::go_on_from_checkpoint(State& state) {
  // Steps that the tables reach; a missing table starts anew.
  int rows = std::numeric_limits<int>::max();
  for (const char* name : {"time_series.csv", "membrane.csv"}) {
    if (!std::filesystem::exists(folder_ / name)) continue;
    const auto table = read_whole_rows(folder_ / name);
    rows = std::min(rows, table.rows() > 0 ? table.steps.back() : 0);
  }
  for (const auto& [step, file] : stored_checkpoints(checkpoint_folder(folder_))) {
    try {
      if (step > rows)
        throw InputError("the tables of the run end before the checkpoint",
                         "rows up to step " + std::to_string(rows), "rows up to step " + std::to_string(step),
                         file.string());
      state = state_of(load_checkpoint(file, stamp_), state, file);
      return saved(step, file);
    } catch (const LaterFormatError&) {
      throw; // whole, and going on from an older one would remove it
    } catch (const InputError& error) {
      damaged_.emplace_back(error.what());
    }
  }
  if (damaged_.empty()) return;
  std::string reasons;
  for (const auto& message : damaged_) reasons += "\n" + message;
  throw InputError("none of the checkpoints can be used" + reasons,
                   std::to_string(damaged_.size()) + " checkpoints",
                   "one whole checkpoint; or --force to start again from rest", folder_.string());
}

void RunDirectory::saved(int step, std::filesystem::path file) {
  saved_step_ = step;
  saved_file_ = std::move(file);
  saved_at_ = std::chrono::steady_clock::now();
}

void RunDirectory::record(const State& state, const Observation& seen) {
  series_->append(state.step, observation_row(seen, view_.rows));
  if (membrane_) {
    const Eigen::VectorXd axial_mm = view_.probes.axial_displacement(state.d[0]) / units::cm_per_mm;
    membrane_->append(state.step, {axial_mm.data(), static_cast<std::size_t>(axial_mm.size())});
  }
  if (view_.rows.pump) wall_shear_.add(state.step, seen.wall_shear);
  const auto due = [&](int every) { return every > 0 && state.step % every == 0; };
  if (due(scene_.output.fields_every)) {
    const auto fields = view_.fluid_fields(state);
    if (view_.moved_fluid) {
      const FieldMesh<2> moved = view_.moved_fluid(state);
      fluid_writer_->write(state.step, state.time, fields, &moved);
    } else {
      fluid_writer_->write(state.step, state.time, fields);
    }
    solid_writer_->write(state.step, state.time, view_.solid_fields(state));
  }
  const std::chrono::duration<double> since_saved = std::chrono::steady_clock::now() - saved_at_;
  if (checkpoint_due(scene_, state.step, saved_step_, since_saved.count())) save_state(state);
  if (view_.rows.pump && due(scene_.time.steps_per_period)) write_summaries();
}

std::filesystem::path RunDirectory::save_state(const State& state) {
  if (fluid_writer_) fluid_writer_->sync();
  if (solid_writer_) solid_writer_->sync();
  if (state.step == saved_step_ && !saved_file_.empty()) return saved_file_;
  // A checkpoint relies on the rows and fields up to its step: they reach the disk first.
  series_->sync();
  if (membrane_) membrane_->sync();
  saved(state.step, save_checkpoint(checkpoint_of(state, stamp_, provenance_), checkpoint_folder(folder_)));
  return saved_file_;
}

void RunDirectory::write_summaries() const {
  write_cycle_means(summarise_cycles(series(), scene_.time.steps_per_period), folder_ / "cycle_means.csv");
  if (!membrane_) return;
  const auto envelope = summarise_cycles(membrane(), scene_.time.steps_per_period);
  const auto& radius = view_.probes.radius;
  const std::size_t last = (envelope.periods.size() - 1) * radius.size();
  std::string text = "radius_mm,low_mm,high_mm\n";
  for (std::size_t k = 0; k < radius.size(); ++k)
    text += exact_number(units::length_to_mm(radius[k])) + "," + exact_number(envelope.minimum[last + k]) +
            "," + exact_number(envelope.maximum[last + k]) + "\n";
  replace_text_file(folder_ / "envelope.csv", text);
  if (wall_shear_.has_period() && !view_.walls.empty())
    write_wall_shear(wall_shear_, view_.walls, folder_ / "wall_shear.csv");
}

void RunDirectory::finish(const State& state, const PhaseTimer& timer) {
  save_state(state);
  if (!view_.rows.pump)
    write_statistics(series_statistics(series(), scene_.output.statistics_from), folder_ / "statistics.csv");
  std::string text = "{\n  \"last_step\": " + std::to_string(state.step) + ",\n  \"phases\": {";
  const char* separator = "\n";
  for (const auto& [phase, record] : timer.records()) {
    text += separator + ("    \"" + phase + "\": {\"seconds\": ") + exact_number(record.seconds) +
            ", \"calls\": " + std::to_string(record.calls) + "}";
    separator = ",\n";
  }
  replace_text_file(folder_ / "timing.json", text + "\n  }\n}\n");
}

} // namespace undula::fom
