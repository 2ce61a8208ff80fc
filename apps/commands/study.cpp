// undula study scene.toml: runs over any keys of a scene, and what the keys do.
//   undula study data/scenes/peristaltic_pump.toml --vary rollers.occlusion=0.7:1:7
//     --vary hose.bore_mm=24:36:4 --vary operating_point.frequency_Hz=0.3:1.5:4 --output study --plot
//   undula study data/scenes/wave_pump_thin_gap.toml --vary membrane.young_dyn_per_cm2=1.2e7:2.2e7
//     --vary geometry.clearance_scale=0.8:1.2 --points 24
//   mpirun -np 2 undula study scene.toml --vary KEY=low:high --points 40
#include <spdlog/spdlog.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include "apps/apps.hpp"
#include "apps/commands/commands.hpp"
#include "apps/input/study_range.hpp"
#include "apps/mpi_session.hpp"
#include "apps/output/progress.hpp"
#include "apps/output/study_report.hpp"
#include "apps/output/text_table.hpp"
#include "apps/stop_signal.hpp"
#include "fom/output/root_rank.hpp"
#include "fom/scene/scene_file.hpp"
#include "fom/scene/scene_reference.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "training/study/run_study.hpp"

namespace undula::apps {
namespace {

struct StudyOptions {
  std::string scene;
  std::vector<std::string> overrides;
  std::vector<std::string> ranges;
  std::optional<int> points;
  std::string output;
  std::string quantity;
  bool plot = false;
  bool json = false;
  std::vector<std::string> petsc;
};

/// Every run of the plan that has no record. Throws Stopped after a signal, with the records stored.
void compute_runs(const StudyPlan& plan, const SceneAtValues& scene_at, int ranks_per_run,
                  const StudyStore& store, const std::string& folder, MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  const auto work = [&](const AfterStep& after_step) {
    std::optional<Progress> progress;
    if (rank == 0) {
      progress.emplace("study", static_cast<long>(plan.points.size()),
                       std::max<long>(1, static_cast<long>(plan.points.size()) / 10));
    }
    const auto tell = [&](const StudyRecord& run, std::size_t done, std::size_t) {
      if (progress) {
        progress->update(static_cast<long>(done));
      }
      if (!run.reason.empty()) {
        spdlog::info("{}: {} ({})", values_text(plan.keys, run.values), run.state, run.reason);
      }
    };
    run_study(plan, scene_at, store, ranks_per_run, comm, tell, after_step);
  };
  run_until_signal(comm, work, [&](const std::string& signal) {
    return "stopped by " + signal + " with " +
           std::to_string(plan.points.size() - store.pending(plan).size()) + " of " +
           std::to_string(plan.points.size()) + " runs stored in " + folder +
           "\n  the same command goes on with the others";
  });
}

void study(const StudyOptions& options, MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);

  // 1. The scene, the plan, and the folder of the runs: all that may be wrong comes before the first run.
  const Scene scene = read_scene(options.scene, options.overrides);
  std::vector<StudyRange> ranges;
  for (const std::string& text : options.ranges) {
    ranges.push_back(parse_study_range(text));
  }
  constexpr int points_per_key = 16;
  const int points = options.points.value_or(points_per_key * static_cast<int>(ranges.size()));
  const StudyPlan plan = plan_study(scene, ranges, points);
  if (plan.full && options.points) {
    throw InputError("a full plan has as many runs as its values ask for", "--points with counts in --vary",
                     "--vary KEY=low:high with --points, or counts alone", "--points");
  }
  const std::string folder = options.output.empty() ? scene.name + "_study" : options.output;
  std::optional<StudyStore> store;
  on_root(comm, [&] {
    store.emplace(folder, stamp_study(scene, plan.keys));
    std::vector<std::string> damaged;
    store->pending(plan, &damaged);
    for (const std::string& message : damaged) {
      spdlog::warn("computed again: {}", message);
    }
  });
  if (rank != 0) {
    store.emplace(folder, stamp_study(scene, plan.keys));
  }

  // 2. The runs that are not there yet. Every scene is read anew, so that all that follows from a key does.
  const SceneAtValues scene_at = [&](const std::vector<double>& values) {
    return read_scene(options.scene, overrides_of(options.overrides, plan.keys, values));
  };
  compute_runs(plan, scene_at, scene.training.ranks_per_run, *store, folder, comm);

  // 3. Tables, sensitivities and pictures, unless another process still computes.
  on_root(comm, [&] {
    if (const auto pending = store->pending(plan); !pending.empty()) {
      spdlog::warn("{} runs are being computed by other processes: call again when they have ended",
                   pending.size());
      return;
    }
    StudyReport report{scene.name, folder, plan, ranges, {}, {}};
    for (const auto& values : plan.points) {
      report.runs.push_back(store->load(values));
    }
    analyse(report);
    const std::string quantity = chosen_quantity(report, options.quantity);
    write_study_table(report, std::filesystem::path(folder) / "table.csv");
    replace_text_file(std::filesystem::path(folder) / "study.json", study_json(report));
    std::cout << (options.json ? study_json(report) : study_text(report, quantity));
    if (options.plot) {
      plot_study(report, quantity, folder);
    }
  });
}

} // namespace

void add_study_command(CLI::App& app) {
  auto options = std::make_shared<StudyOptions>();
  CLI::App* command =
      app.add_subcommand("study", "Run a scene over ranges of its keys: table, sensitivities");
  command->add_option("scene", options->scene, "scene file (TOML)")->required();
  command
      ->add_option("--vary", options->ranges,
                   "a key and its range, may be repeated; with a count for every key a full plan, without a "
                   "space-filling one")
      ->type_name("KEY=LOW:HIGH[:COUNT]")
      ->required()
      ->allow_extra_args(false);
  command->add_option("--points", options->points,
                      "runs of a space-filling plan; default: 16 per key. More keep the earlier ones");
  command->add_option("--set", options->overrides, "override a key: section.key=value, may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_option("--output", options->output,
                      "folder of runs and results, resumed if it exists; default NAME_study");
  command->add_option(
      "--quantity", options->quantity,
      "what is printed and drawn of the sensitivities; default: the first, the mean flow of a "
      "pump. The table and JSON hold all");
  command->add_flag("--plot", options->plot, "draw pictures of runs and sensitivities into the folder");
  command->add_flag("--json", options->json, "print JSON");
  command->add_option("petsc", options->petsc, "options for PETSc, after --");
  command->footer(scene_keys_help());
  command->callback(
      [options] { run_parallel(options->petsc, [&](MPI_Comm comm) { study(*options, comm); }); });
}

} // namespace undula::apps
