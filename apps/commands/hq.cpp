// undula hq model.h5|scene.toml: the head-flow curve of a reduced model, or of full-order runs.
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
#include "apps/input/scene_flow.hpp"
#include "apps/mpi_session.hpp"
#include "apps/output/gnuplot.hpp"
#include "apps/output/hq_report.hpp"
#include "apps/output/progress.hpp"
#include "apps/output/scene_curve.hpp"
#include "apps/output/text_table.hpp"
#include "fom/output/root_rank.hpp"
#include "rom/base/error.hpp"
#include "rom/base/units.hpp"
#include "training/calibration/scene_flows.hpp"
#include "training/calibration/uncertainty.hpp"
#include "training/campaign/curve.hpp"

namespace undula::apps {
namespace {

constexpr int default_points = 12;

struct HqCommandOptions {
  std::string model;
  std::optional<double> frequency_Hz;
  std::optional<double> stroke_mm;
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

/// Runs of another operating point are not drawn.
void warn_of_other_runs(const SceneCurve& runs, const std::string& file, double frequency_Hz,
                        double stroke_mm) {
  if (!same_setting(runs.frequency_Hz, frequency_Hz) || !same_setting(runs.stroke_mm, stroke_mm)) {
    spdlog::warn("{} holds runs of another operating point, {} Hz, stroke {} mm, which are not drawn", file,
                 shortest(runs.frequency_Hz), shortest(runs.stroke_mm));
  }
}

void warn_outside(const rom::Model& model, double frequency_Hz, double stroke_mm,
                  std::span<const double> heads) {
  for (const std::string& line : rom::outside_training_box(model.box, frequency_Hz, stroke_mm, heads)) {
    spdlog::warn("{}", line);
  }
}

void hq_of_model(const HqCommandOptions& options) {
  if (!options.beside.empty()) {
    throw InputError("a reduced model stands beside a scene only", options.beside,
                     "a scene (.toml) with --beside", "the command line");
  }
  if (!options.overrides.empty() || !options.petsc.empty() || options.band) {
    throw InputError("options of scenes do not go with a reduced model", options.model,
                     "a scene (.toml) with --set, --band and options for PETSc", "the command line");
  }
  if (!options.frequency_Hz || !options.stroke_mm) {
    throw CLI::RequiredError(options.frequency_Hz ? "--stroke" : "--frequency");
  }
  // 1. Everything that may be wrong with the input comes before the first result.
  if (!options.picture.empty()) {
    check_picture_name(options.picture);
  }
  rom::Model model = rom::load_model(options.model);
  const std::vector<double> heads =
      options.heads.empty() ? even_heads(model.box.head_low_mmHg, model.box.head_high_mmHg, default_points)
                            : parse_heads(options.heads);
  std::optional<MeasuredCurve> measured;
  if (!options.data.empty()) {
    measured = read_measured_curve(options.data);
  }

  if (measured) {
    warn_of_other_point(*measured, options.data, "the model", *options.frequency_Hz, *options.stroke_mm);
  }

  if (!options.runs.empty()) {
    const SceneCurve runs = read_scene_curve(options.runs);
    warn_of_other_runs(runs, options.runs, *options.frequency_Hz, *options.stroke_mm);
    for (std::size_t i = 0; i < runs.head_mmHg.size(); ++i) {
      rom::ReferencePoint run;
      run.frequency_Hz = runs.frequency_Hz;
      run.stroke_mm = runs.stroke_mm;
      run.head_mmHg = runs.head_mmHg[i];
      run.flow_l_per_min = runs.flow_l_per_min[i];
      model.references.push_back(run);
    }
  }

  // 2. The curve, and how far it can be trusted.
  const auto begin = std::chrono::steady_clock::now();
  const auto points = rom::hq_curve(model, *options.frequency_Hz, *options.stroke_mm, heads);
  const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - begin;
  warn_outside(model, *options.frequency_Hz, *options.stroke_mm, heads);
  for (const rom::HqPoint& point : points) {
    if (!point.converged) {
      spdlog::warn("no periodic state at {} mmHg: the flow is the mean of the last period", point.head_mmHg);
    }
  }

  if (!options.json) { // JSON holds the time itself
    spdlog::info("{} points in {} ms", points.size(), decimals(elapsed.count(), 0));
  }

  // 3. Numbers to stdout, picture beside them.
  const HqReport report = {options.model, *options.frequency_Hz,           *options.stroke_mm,
                           points,        measured ? &*measured : nullptr, elapsed.count()};
  std::cout << (options.json ? hq_json(report) : hq_table(report));
  if (!options.picture.empty()) {
    plot_hq_report(options.picture, report, model);
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

void hq_of_scene(const HqCommandOptions& options, MPI_Comm comm) {
  // 1. Everything that may be wrong with the input comes before the first result.
  const auto begin = std::chrono::steady_clock::now();
  if (!options.picture.empty()) {
    check_picture_name(options.picture);
  }
  const Scene scene =
      read_scene_at(options.model, options.overrides, options.frequency_Hz, options.stroke_mm);
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
  std::optional<SceneCurve> other_runs;
  if (measured) {
    warn_of_other_point(*measured, options.data, "the scene", scene.operating_point.frequency,
                        units::length_to_mm(scene.operating_point.stroke));
  }
  if (!options.runs.empty()) {
    other_runs = read_scene_curve(options.runs);
    warn_of_other_runs(*other_runs, options.runs, scene.operating_point.frequency,
                       units::length_to_mm(scene.operating_point.stroke));
  }
  std::optional<rom::Model> model;
  if (!options.beside.empty()) {
    model = rom::load_model(options.beside);
  }

  // 2. The periodic state at every head, on a level prepared once.
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  PhaseTimer timer;
  PreparedLevel level = prepare_level(scene, comm, timer);
  std::vector<CurvePoint> points;
  {
    std::optional<Progress> progress;
    if (rank == 0) {
      progress.emplace("hq", static_cast<long>(heads.size()));
    }
    long done = 0;
    points = head_flow_curve(level, scene, heads, [&] {
      ++done;
      if (progress) {
        progress->update(done);
      }
    });
  }
  // 3. What the tolerances of the inputs do to it.
  std::optional<UncertaintyBand> band;
  if (options.band) {
    band = band_of_curve(scene, points, comm);
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  std::vector<rom::HqPoint> reduced;
  if (model) {
    const double frequency_Hz = scene.operating_point.frequency;
    const double stroke_mm = units::length_to_mm(scene.operating_point.stroke);
    reduced = rom::hq_curve(*model, frequency_Hz, stroke_mm, heads);
    if (rank == 0) {
      warn_outside(*model, frequency_Hz, stroke_mm, heads);
    }
  }

  // 4. Numbers to stdout, picture beside them.
  on_root(comm, [&] {
    for (const CurvePoint& point : points) {
      if (!point.periodic) {
        spdlog::warn("no periodic state at {} mmHg: {}", shortest(point.head_mmHg), point.reason);
      }
    }
    if (std::ranges::none_of(points, [](const auto& point) { return std::isfinite(point.flow_l_per_min); })) {
      throw NumericsError("the curve has no point", "every head", "what the warnings above say");
    }
    if (!options.json) { // JSON holds the time itself
      spdlog::info("{} points in {} s", points.size(), decimals(elapsed.count(), 1));
    }
    const SceneReport report = {scene,
                                unknowns(level),
                                points,
                                timer,
                                elapsed.count(),
                                measured ? &*measured : nullptr,
                                band ? &*band : nullptr,
                                reduced};
    std::cout << (options.json ? scene_curve_json(report) : scene_curve_table(report));
    if (band && !options.json) {
      std::cout << "\n" << sensitivity_table(report);
    }
    if (!options.picture.empty()) {
      plot_scene_curve(options.picture, report, other_runs);
    }
  });
}

void hq(const HqCommandOptions& options) {
  if (is_scene_file(options.model)) {
    run_parallel(options.petsc, [&](MPI_Comm comm) { hq_of_scene(options, comm); });
  } else if (is_first_process()) {
    hq_of_model(options);
  }
}

} // namespace

void add_hq_command(CLI::App& app) {
  auto options = std::make_shared<HqCommandOptions>();
  CLI::App* command = app.add_subcommand(
      "hq", "Head-flow curve of a reduced model or of full-order runs (table, JSON, plot)");
  command->add_option("model", options->model, "model file (HDF5) made by undula train, or a scene (.toml)")
      ->required();
  command->add_option("--frequency", options->frequency_Hz,
                      "frequency of the actuator, Hz; a scene has its own");
  command->add_option("--stroke", options->stroke_mm, "amplitude of the actuator, mm; a scene has its own");
  command->add_option(
      "--head", options->heads,
      "heads in mmHg, low:high:step or a list with commas; default: 12 over the training box");
  command->add_option("--data", options->data, "measured points (CSV: head_mmHg,flow_l_per_min)");
  command->add_option("--runs", options->runs,
                      "full-order runs to draw beside the curve (what `hq SCENE --json` prints)");
  command->add_option("--beside", options->beside, "reduced model (.h5) to show beside a scene's curve");
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
  command->callback([options] { hq(*options); });
}

} // namespace undula::apps
