#include "fom/output/run_directory.hpp"

#include "fom/output/provenance.hpp"
#include "fom/output/series_statistics.hpp"
#include "fom/output/state_file.hpp"
#include "fom/scene/scene_file.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::fom {
namespace {

constexpr std::string_view stamp_prefix = "# undula run of the scene with hash ";

/// Hash and name of the scene whose run a folder holds.
struct RunThere {
  std::string hash, name;
};

std::optional<RunThere> run_in(const std::filesystem::path& folder) {
  const auto file = folder / "scene_resolved.toml";
  if (!std::filesystem::exists(file)) return std::nullopt;
  const std::string text = read_text_file(file);
  if (!text.starts_with(stamp_prefix))
    throw InputError("the output folder holds a foreign scene", "no stamp in its first line",
                     "a folder that `undula solve` made, or a new one", file.string());
  RunThere there;
  there.hash = text.substr(stamp_prefix.size(), text.find('\n') - stamp_prefix.size());
  // The rest may name files that have moved since, so it is not parsed as a scene.
  constexpr std::string_view key = "\nname = \"";
  if (const auto begin = text.find(key); begin != std::string::npos)
    there.name = text.substr(begin + key.size(), text.find('"', begin + key.size()) - begin - key.size());
  return there;
}

std::filesystem::path checkpoint_folder(const std::filesystem::path& folder) {
  return folder / "checkpoints";
}

std::vector<std::string> probe_columns(const MembraneProbes& probes) {
  std::vector<std::string> columns;
  for (const double radius : probes.radius)
    columns.push_back("displacement_mm_at_r_" + exact_number(units::length_to_mm(radius)) + "_mm");
  return columns;
}

void remove_results(const std::filesystem::path& folder) {
  // Checkpoints first: at no moment could a restart mix two runs.
  std::filesystem::remove_all(checkpoint_folder(folder));
  for (const char* name : {"cycle_means.csv", "envelope.csv", "statistics.csv", "timing.json"})
    std::filesystem::remove(folder / name);
}

} // namespace

void check_checkpoint_interval(const Scene& scene) {
  if (scene.output.checkpoint_every % scene.time.factor_every == 0) return;
  throw InputError("checkpoints do not fall on fresh factorisations, so a restart would not repeat the run",
                   "output.checkpoint_every = " + std::to_string(scene.output.checkpoint_every),
                   "a multiple of time.factor_every = " + std::to_string(scene.time.factor_every),
                   scene.file.string() + ", section [output]");
}

void check_run_directory(const std::filesystem::path& folder, const Scene& scene, ExistingRun existing) {
  if (std::filesystem::exists(folder) && !std::filesystem::is_directory(folder))
    throw InputError("the output folder is a file", folder.string(), "a folder, or a name not yet taken",
                     "--output");
  if (existing == ExistingRun::replace) return;
  const auto there = run_in(folder);
  if (!there) return;
  const std::string hash = scene_hash(scene);
  const std::string seen = "scene \"" + there->name + "\" with hash " + there->hash;
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
}

RunDirectory::RunDirectory(std::filesystem::path folder, LevelView view, const Scene& scene,
                           ExistingRun existing, int ranks, State& state)
    : folder_(std::move(folder)),
      view_(std::move(view)),
      scene_(scene),
      stamp_(stamp_scene(scene)),
      provenance_(provenance(ranks)) {
  check_run_directory(folder_, scene, existing);
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error)
    throw InputError("cannot create the output folder", error.message(), "a writable place",
                     folder_.string());

  // 1. The state to go on from.
  if (existing == ExistingRun::go_on) {
    if (const auto file = newest_checkpoint(checkpoint_folder(folder_))) {
      const auto checkpoint = load_checkpoint(*file, stamp_);
      state = state_of(checkpoint, state, *file);
      saved_step_ = state.step;
    }
  } else {
    remove_results(folder_);
  }
  replace_text_file(folder_ / "scene_resolved.toml",
                    std::string(stamp_prefix) + stamp_.hash + "\n" + stamp_.text);

  // 2. Tables and fields: from the start, or as they were at that state.
  const auto table = [&](const char* name, std::vector<std::string> columns) {
    return state.step == 0 ? TimeSeriesFile::start(folder_ / name, std::move(columns))
                           : TimeSeriesFile::go_on(folder_ / name, std::move(columns), state.step);
  };
  series_.emplace(table("time_series.csv", observation_columns(view_.rows)));
  if (view_.rows.pump) membrane_.emplace(table("membrane.csv", probe_columns(view_.probes)));
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

void RunDirectory::record(const State& state, const Observation& seen) {
  series_->append(state.step, observation_row(seen, view_.rows));
  if (membrane_) {
    const Eigen::VectorXd axial_mm = view_.probes.axial_displacement(state.d[0]) / units::cm_per_mm;
    membrane_->append(state.step, {axial_mm.data(), static_cast<std::size_t>(axial_mm.size())});
  }
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
  if (due(scene_.output.checkpoint_every)) save_state(state);
  if (view_.rows.pump && due(scene_.time.steps_per_period)) write_summaries();
}

std::filesystem::path RunDirectory::save_state(const State& state) {
  const auto folder = checkpoint_folder(folder_);
  if (state.step == saved_step_) return *newest_checkpoint(folder);
  const auto file = save_checkpoint(checkpoint_of(state, stamp_, provenance_), folder);
  saved_step_ = state.step;
  return file;
}

void RunDirectory::write_summaries() const {
  write_cycle_means(summarise_cycles(series(), scene_.time.steps_per_period), folder_ / "cycle_means.csv");
  const auto envelope = summarise_cycles(membrane(), scene_.time.steps_per_period);
  const auto& radius = view_.probes.radius;
  const std::size_t last = (envelope.periods.size() - 1) * radius.size();
  std::string text = "radius_mm,low_mm,high_mm\n";
  for (std::size_t k = 0; k < radius.size(); ++k)
    text += exact_number(units::length_to_mm(radius[k])) + "," + exact_number(envelope.minimum[last + k]) +
            "," + exact_number(envelope.maximum[last + k]) + "\n";
  replace_text_file(folder_ / "envelope.csv", text);
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
