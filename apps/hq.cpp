// undula hq model.h5|scene.toml: the head-flow curve of a reduced model, or of full-order runs.
//   undula hq data/models/wave_pump_fixed.h5 --frequency 120 --stroke 0.53 --head 40:62:2
//   undula hq model.h5 --frequency 120 --stroke 0.53 --head 50,55,60 --json
//   undula hq model.h5 --frequency 120 --stroke 0.53 --data data/measured/corwave_120hz_0.53mm.csv --plot
//   hq.png
//   undula hq data/scenes/wave_pump_fixed.toml --head 0,20,40,60 --set mesh.gap_elements=3
#include <spdlog/spdlog.h>

#include <chrono>
#include <iostream>
#include <memory>
#include <optional>

#include "apps/commands.hpp"
#include "apps/gnuplot.hpp"
#include "apps/head_list.hpp"
#include "apps/hq_report.hpp"
#include "apps/mpi_session.hpp"
#include "apps/progress.hpp"
#include "apps/scene_curve.hpp"
#include "apps/scene_flow.hpp"
#include "apps/text_table.hpp"
#include "base/error.hpp"
#include "base/units.hpp"
#include "training/periodic_run.hpp"

namespace undula {
namespace {

struct HqCommandOptions {
  std::string model;
  std::optional<double> frequency_Hz;
  std::optional<double> stroke_mm;
  std::string heads;
  std::string data;
  std::string runs;
  std::string picture;
  bool json = false;
  std::vector<std::string> overrides;
  std::vector<std::string> petsc;
};

void hq_of_model(const HqCommandOptions& options) {
  if (!options.overrides.empty() || !options.petsc.empty()) {
    throw InputError("options of scenes do not go with a reduced model", options.model,
                     "a scene (.toml) with --set and options for PETSc", "the command line");
  }
  if (!options.frequency_Hz || !options.stroke_mm) {
    throw CLI::RequiredError(options.frequency_Hz ? "--stroke" : "--frequency");
  }
  // 1. Everything that may be wrong with the input comes before the first result.
  if (!options.picture.empty()) {
    check_picture_name(options.picture);
  }
  rom::Model model = rom::load_model(options.model);
  constexpr int default_points = 12;
  const std::vector<double> heads =
      options.heads.empty() ? even_heads(model.box.head_low_mmHg, model.box.head_high_mmHg, default_points)
                            : parse_heads(options.heads);
  std::optional<MeasuredCurve> measured;
  if (!options.data.empty()) {
    measured = read_measured_curve(options.data);
  }

  if (!options.runs.empty()) {
    const SceneCurve runs = read_scene_curve(options.runs);
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
  for (const std::string& line :
       rom::outside_training_box(model.box, *options.frequency_Hz, *options.stroke_mm, heads)) {
    spdlog::warn("{}", line);
  }
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

void hq_of_scene(const HqCommandOptions& options, MPI_Comm comm) {
  // 1. The scene and the heads.
  if (options.heads.empty()) {
    throw CLI::RequiredError("--head");
  }
  if (!options.data.empty() || !options.picture.empty()) {
    throw InputError("comparing full-order runs with data is the task of another command", options.model,
                     "undula validate SCENE --data FILE --plot PICTURE", "the command line");
  }
  const Scene scene =
      read_scene_at(options.model, options.overrides, options.frequency_Hz, options.stroke_mm);
  const std::vector<double> heads = parse_heads(options.heads);

  // 2. One full-order run to its periodic state per head; meshes and operators are shared.
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  PhaseTimer timer;
  const auto prepared = prepare_scene(scene, comm, timer);
  std::optional<Progress> progress;
  if (rank == 0) {
    progress.emplace("hq", static_cast<long>(heads.size()));
  }
  std::vector<ScenePoint> points;
  for (const double head : heads) {
    Scene at_head = scene;
    at_head.operating_point.head = units::pressure_from_mmHg(head);
    points.push_back(scene_point(periodic_run(*prepared, at_head)));
    if (progress) {
      progress->update(static_cast<long>(points.size()));
    }
  }
  progress.reset();

  // 3. Numbers to stdout.
  if (rank == 0) {
    std::cout << (options.json ? scene_curve_json(scene, prepared->disc.unknowns(), points, timer)
                               : scene_curve_table(points));
  }
}

void hq(const HqCommandOptions& options) {
  if (std::filesystem::path(options.model).extension() == ".toml") {
    run_parallel(options.petsc, [&](MPI_Comm comm) { hq_of_scene(options, comm); });
  } else {
    hq_of_model(options);
  }
}

} // namespace

void add_hq_command(CLI::App& app) {
  auto options = std::make_shared<HqCommandOptions>();
  CLI::App* command = app.add_subcommand(
      "hq", "Head-flow curve of a reduced model (table, JSON, plot) or of full-order runs");
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
                      "full-order runs to draw beside a model (what `hq SCENE --json` prints)");
  command->add_option("--plot", options->picture, "picture to draw (.png)");
  command->add_flag("--json", options->json, "print JSON");
  command
      ->add_option("--set", options->overrides,
                   "override a key of a scene: section.key=value, may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_option("petsc", options->petsc, "options for PETSc, after -- (scenes)");
  command->callback([options] { hq(*options); });
}

} // namespace undula
