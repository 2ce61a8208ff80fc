// undula show RUN: pictures of what was computed before, by the code that drew them first. Nothing is
// computed again.
//   undula show run                              the folder of undula solve
//   undula show run --output pictures
//   undula show curve.json --data measured.csv   what undula hq --json printed
#include <spdlog/spdlog.h>

#include <memory>

#include "apps/apps.hpp"
#include "apps/commands/commands.hpp"
#include "apps/mpi_session.hpp"
#include "apps/output/shown_curves.hpp"
#include "apps/output/solve_plots.hpp"
#include "fom/levels/level.hpp"
#include "fom/output/finished_run.hpp"
#include "fom/output/root_rank.hpp"
#include "rom/base/error.hpp"

namespace undula::apps {
namespace {

struct ShowOptions {
  std::string run;
  std::string output;
  std::vector<std::string> data;
  std::vector<std::string> overrides;
};

/// On one rank.
void draw_run(const ShowOptions& options, const Scene& scene, const LevelView& view, const FinishedRun& run) {
  const std::filesystem::path target = options.output.empty() ? options.run : options.output;
  std::error_code error;
  std::filesystem::create_directories(target, error);
  if (error) {
    throw InputError("cannot create the folder of the pictures", error.message(), "a writable place",
                     target.string());
  }
  plot_run({target, view, run.series, run.membrane.columns.empty() ? nullptr : &run.membrane, run.wall_shear},
           scene, run.state);
  spdlog::info("pictures of step {}: {}", run.state.step, target.string());
}

void show_run(const ShowOptions& options, MPI_Comm comm) {
  // 1. The scene of the run, and the level that it was computed on, at rest.
  const Scene scene = read_run_scene(options.run, options.overrides);
  PhaseTimer timer;
  const auto level = prepare_level(scene, comm, timer);
  const LevelView view = level->view(scene);

  // 2. Its last state and its tables.
  FinishedRun run;
  State state = level->initial_state();
  on_root(comm, [&] {
    run = read_finished_run(options.run, scene, view, state);
    state = run.state;
    for (const std::string& message : run.damaged) {
      spdlog::warn("an older checkpoint is drawn: {}", message);
    }
    if (run.series.rows() > 0 && run.series.steps.back() != state.step) {
      spdlog::warn("fields are drawn as of step {}, the last one that was kept; the tables go to step {}",
                   state.step, run.series.steps.back());
    }
  });
  broadcast_state(comm, state);

  // 3. A march that begins there brings the level's geometry to that state. No step is taken.
  const auto there = level->start(scene, state, timer);
  on_root(comm, [&] { draw_run(options, scene, view, run); });
}

void show(const ShowOptions& options) {
  const std::filesystem::path run = options.run;
  if (!std::filesystem::exists(run)) {
    throw InputError("there is nothing to show", '"' + options.run + "\" does not exist",
                     "a folder that `undula solve` wrote, or a file that `undula hq --json` printed",
                     "the command line");
  }
  if (std::filesystem::exists(run / "study.h5")) {
    throw InputError("a study is drawn by undula study", options.run,
                     "the command that made it, with --plot: runs that are recorded are not computed again",
                     "the command line");
  }
  if (std::filesystem::is_directory(run)) {
    if (!options.data.empty()) {
      throw InputError("measured points go with curves", "--data",
                       "--data with a file that `undula hq --json` printed", "the command line");
    }
    run_parallel({}, [&](MPI_Comm comm) { show_run(options, comm); });
    return;
  }
  if (!is_first_process()) {
    return;
  }
  std::vector<MeasuredCurve> measured;
  for (const std::string& file : options.data) {
    measured.push_back(read_measured_curve(file));
  }
  std::filesystem::path picture = options.output;
  if (picture.empty()) {
    picture = run;
    picture.replace_extension(".png");
  }
  show_curves(run, measured, picture);
}

} // namespace

void add_show_command(CLI::App& app) {
  auto options = std::make_shared<ShowOptions>();
  CLI::App* command = app.add_subcommand("show", "Draw a finished run or a recorded curve again");
  command
      ->add_option("run", options->run,
                   "folder that undula solve wrote, or a file that undula hq --json printed")
      ->required();
  command->add_option("--output", options->output,
                      "folder of the pictures of a run, default: its own; or picture of curves (.png), "
                      "default: beside the file");
  command->add_option("--data", options->data, "with curves: measured points (CSV), may be repeated")
      ->allow_extra_args(false);
  command
      ->add_option("--set", options->overrides,
                   "of a run: a key whose file has moved, geometry.profile=\"FILE\"")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->callback([options] { show(*options); });
}

} // namespace undula::apps
