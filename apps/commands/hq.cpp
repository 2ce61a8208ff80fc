// undula hq model.h5|scene.toml: the head-flow curve of a reduced model, or of the level that a scene states.
//   undula hq data/models/wave_pump_fixed.h5 --frequency 120 --stroke 0.53 --head 40:62:2
//   undula hq model.h5 --frequency 120 --stroke 0.53 --head 50,55,60 --json
//   undula hq model.h5 --frequency 120 --stroke 0.53 --data data/measured/corwave_120hz_0.53mm.csv --plot
//   hq.png
//   undula hq data/scenes/wave_pump_thin_gap.toml --data data/measured/corwave_120hz_0.53mm.csv --plot hq.png
//   undula hq data/scenes/wave_pump_thin_gap.toml --band --plot hq.png
//   undula hq data/scenes/wave_pump_fixed.toml --head 0,20,40,60 --set mesh.gap_elements=3
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>

#include "apps/apps.hpp"
#include "apps/commands/commands.hpp"
#include "apps/input/head_list.hpp"
#include "apps/input/level_source.hpp"
#include "apps/mpi_session.hpp"
#include "apps/output/curve_progress.hpp"
#include "apps/output/curve_report.hpp"
#include "apps/output/curve_warnings.hpp"
#include "apps/output/gnuplot.hpp"
#include "apps/output/text_table.hpp"
#include "fom/output/root_rank.hpp"
#include "fom/scene/operating_point.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"
#include "training/calibration/scene_flows.hpp"
#include "training/calibration/uncertainty.hpp"

namespace undula::apps {
namespace {

constexpr int default_points = 12;

struct HqCommandOptions {
  std::string file;
  std::optional<double> frequency_Hz;
  std::optional<double> stroke_mm;
  std::optional<double> voltage_V;
  std::string heads;
  std::string data;
  std::string runs;
  std::string beside;
  std::string picture;
  bool band = false;
  bool json = false;
  std::vector<std::string> overrides;
  std::vector<std::string> petsc;
};

/// The level beside the curve: at the frequency and stroke that its holder makes. Beside one that a voltage
/// drives, a scene keeps its own drive.
LevelSource read_beside(const HqCommandOptions& options, const Scene& scene) {
  const auto& point = scene.operating_point;
  if (point.drive == Drive::voltage) {
    if (!is_scene(options.beside)) {
      throw InputError("a reduced model of this version is driven by a stroke", options.beside,
                       "--beside with a scene (.toml), where a voltage drives the curve", "--beside");
    }
    return read_level_source(options.beside, {}, point.frequency, {});
  }
  const double stroke =
      units::length_to_mm(point.stroke) * (is_scene(options.beside) ? 1 : point.stroke_scale);
  return read_level_source(options.beside, {}, point.frequency, stroke);
}

/// Of the same level at another drive: which.
std::string name_beside(const Level& other, const Level& level, const LevelSource& source,
                        const Scene& scene) {
  const bool told_apart =
      other.name() != level.name() || source.scene.operating_point.drive == scene.operating_point.drive;
  return other.name() + (told_apart ? "" : ", " + setting_text(source.scene.operating_point));
}

/// Runs of another operating point are not drawn.
void warn_of_other_runs(const RecordedCurve& runs, const std::string& file, double frequency_Hz,
                        double stroke_mm) {
  if (!same_setting(runs.frequency_Hz, frequency_Hz) || !same_setting(runs.stroke_mm, stroke_mm)) {
    spdlog::warn("{} holds runs of another operating point, {} Hz, stroke {} mm, which are not drawn", file,
                 plain_number(runs.frequency_Hz), plain_number(runs.stroke_mm));
  }
}

/// The band of a curve. Curves of thin gaps need one rank each, so that every rank computes its own; those of
/// finite elements take all ranks one after the other.
UncertaintyBand band_of_curve(const Scene& scene, std::span<const CurvePoint> points, MPI_Comm comm) {
  std::vector<double> heads, flows;
  for (const CurvePoint& point : points) {
    heads.push_back(point.head_mmHg);
    flows.push_back(point.flow_l_per_min);
  }
  const bool alone = scene.space == Space::thin_gap;
  const MPI_Comm curve_comm = alone ? MPI_COMM_SELF : comm;
  return propagate_tolerances(
      scene, flows, [&](const Scene& moved) { return scene_flows(moved, heads, curve_comm).flow_l_per_min; },
      alone ? comm : MPI_COMM_SELF);
}

void hq(const HqCommandOptions& options, MPI_Comm comm) {
  // 1. Everything that may be wrong with the input comes before the first result.
  const auto begin = std::chrono::steady_clock::now();
  if (!options.picture.empty()) {
    check_picture_name(options.picture);
  }
  const LevelSource source = read_level_source(options.file, options.overrides, options.frequency_Hz,
                                               options.stroke_mm, options.voltage_V);
  const Scene& scene = source.scene;
  if (options.band && source.model) {
    throw InputError("a reduced model states no tolerances of its inputs", "--band",
                     "--band with a scene (.toml); a reduced model prints its own error", options.file);
  }
  if (options.band) {
    check_tolerances(scene);
  }
  const std::vector<double> heads =
      options.heads.empty() ? even_heads(units::pressure_to_mmHg(scene.training.head_low),
                                         units::pressure_to_mmHg(scene.training.head_high), default_points)
                            : parse_heads(options.heads);
  std::optional<MeasuredCurve> measured;
  if (!options.data.empty()) {
    measured = read_measured_curve(options.data);
  }
  const double frequency_Hz = scene.operating_point.frequency,
               stroke_mm = units::length_to_mm(scene.operating_point.stroke);
  const std::string asked = source.model ? "the model" : "the scene";
  if (measured) {
    warn_of_other_point(*measured, options.data, asked, scene.operating_point);
  }
  std::vector<RecordedCurve> recorded;
  if (!options.runs.empty()) {
    recorded.push_back(read_recorded_curve(options.runs));
    warn_of_other_runs(recorded.back(), options.runs, frequency_Hz, stroke_mm);
  }
  if (source.model) {
    recorded.push_back(kept_runs(*source.model, scene.operating_point.frequency, *options.stroke_mm));
  }
  std::optional<LevelSource> other;
  if (!options.beside.empty()) {
    other = read_beside(options, scene);
  }

  // 2. The periodic state at every head, on a level prepared once.
  PhaseTimer timer;
  const auto level = prepare(source, comm, timer);
  const std::vector<CurvePoint> points = curve_with_progress("hq", *level, scene, heads, comm);

  // 3. What the tolerances of the inputs do to it; what stands beside it.
  std::optional<UncertaintyBand> band;
  if (options.band) {
    band = band_of_curve(scene, points, comm);
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  std::unique_ptr<Level> other_level;
  std::vector<CurvePoint> beside;
  if (other) {
    PhaseTimer other_timer;
    other_level = prepare(*other, comm, other_timer);
    beside = other_level->curve(other->scene, heads);
  }

  // 4. Numbers to stdout, picture beside them.
  on_root(comm, [&] {
    warn_of_curve(*level, scene, points);
    if (other) {
      warn_of_curve(*other_level, other->scene, beside);
    }
    if (std::ranges::none_of(points, [](const auto& point) { return std::isfinite(point.flow_l_per_min); })) {
      throw NumericsError("the curve has no point", "every head", "what the warnings above say");
    }
    if (!options.json) { // JSON holds the time itself
      spdlog::info("{} points in {} s", points.size(), decimals(elapsed.count(), 2));
    }
    const CurveReport report = {scene,
                                level->name(),
                                source.model ? options.file : "",
                                level->unknowns(),
                                points,
                                timer,
                                elapsed.count(),
                                measured ? &*measured : nullptr,
                                band ? &*band : nullptr,
                                other ? name_beside(*other_level, *level, *other, scene) : "",
                                beside,
                                recorded};
    std::cout << (options.json ? curve_json(report) : curve_table(report));
    if (band && !options.json) {
      std::cout << "\n" << sensitivity_table(report);
    }
    if (!options.picture.empty()) {
      plot_curve_report(options.picture, report);
    }
  });
}

} // namespace

void add_hq_command(CLI::App& app) {
  auto options = std::make_shared<HqCommandOptions>();
  CLI::App* command =
      app.add_subcommand("hq", "Head-flow curve of a reduced model or of a scene (table, JSON, plot)");
  command->add_option("model", options->file, "model file (HDF5) made by undula train, or a scene (.toml)")
      ->required();
  command->add_option("--frequency", options->frequency_Hz,
                      "frequency of the actuator, Hz; a scene has its own");
  CLI::Option* stroke = command->add_option("--stroke", options->stroke_mm,
                                            "amplitude of the actuator, mm; a scene has its own");
  command
      ->add_option("--voltage", options->voltage_V,
                   "of a scene: amplitude of the voltage that drives its actuator, V")
      ->excludes(stroke);
  command->add_option(
      "--head", options->heads,
      "heads in mmHg, low:high:step or a list with commas; default: 12 over the training box");
  command->add_option("--data", options->data, "measured points (CSV: head_mmHg,flow_l_per_min)");
  command->add_option("--runs", options->runs,
                      "recorded runs to draw beside the curve (what `hq FILE --json` prints)");
  command->add_option("--beside", options->beside,
                      "reduced model (.h5) or scene (.toml) to show beside the curve");
  command->add_option("--plot", options->picture, "picture to draw (.png)");
  command->add_flag("--band", options->band,
                    "of a scene: the band that the tolerances of its inputs give, and what each contributes");
  command->add_flag("--json", options->json, "print JSON");
  command
      ->add_option("--set", options->overrides,
                   "override a key of a scene: section.key=value, may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_option("petsc", options->petsc, "options for PETSc, after -- (scenes)");
  command->callback([options] {
    const bool models_alone =
        !is_scene(options->file) && (options->beside.empty() || !is_scene(options->beside));
    (models_alone ? run_alone : run_parallel)(options->petsc, [&](MPI_Comm comm) { hq(*options, comm); });
  });
}

} // namespace undula::apps
