// undula solve scene.toml: one full-order run.
//   undula solve data/scenes/wave_pump_fixed.toml --output run --plot
//   undula solve data/scenes/wave_pump_fixed.toml --output run --restart --set time.periods=20
//   undula solve data/scenes/wave_pump_thin_gap.toml --output run --plot
//   undula solve data/scenes/cylinder_2d1.toml --output run --plot --set domain.size_mm=10
//   mpirun -np 2 undula solve data/scenes/wave_pump_fixed.toml --output run --json -- -log_view
#include <spdlog/spdlog.h>

#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>

#include "apps/apps.hpp"
#include "apps/commands/commands.hpp"
#include "apps/input/level_source.hpp"
#include "apps/mpi_session.hpp"
#include "apps/output/curve_report.hpp"
#include "apps/output/curve_warnings.hpp"
#include "apps/output/hose_report.hpp"
#include "apps/output/progress.hpp"
#include "apps/output/solve_plots.hpp"
#include "apps/output/text_table.hpp"
#include "apps/stop_signal.hpp"
#include "fom/levels/march.hpp"
#include "fom/levels/periodic_run.hpp"
#include "fom/output/folder_lock.hpp"
#include "fom/output/root_rank.hpp"
#include "fom/output/run_directory.hpp"
#include "fom/output/series_statistics.hpp"
#include "fom/output/settled_mean.hpp"
#include "fom/scene/scene_file.hpp"
#include "fom/scene/scene_reference.hpp"
#include "fom/scene/scene_time.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"

namespace undula::apps {
namespace {

struct SolveOptions {
  std::string scene;
  std::vector<std::string> overrides;
  std::string output;
  bool restart = false;
  bool force = false;
  bool plot = false;
  bool json = false;
  std::vector<std::string> petsc;
};

struct SolvedRun {
  std::string scene, hash, folder;
  int unknowns = 0, ranks = 1;
  int first_step = 0, last_step = 0;        ///< of this process; the run itself begins at rest
  std::vector<PeriodSummary> periods;       ///< of a pump
  std::vector<ColumnStatistics> statistics; ///< of a scene that states its problem
};

SolvedRun summary(const Scene& scene, const RunDirectory& output, int unknowns, int ranks, int first_step,
                  int last_step) {
  SolvedRun run = {
      scene.name, scene_hash(scene), output.folder().string(), unknowns, ranks, first_step, last_step, {},
      {}};
  if (scene.problem.general) {
    run.statistics = series_statistics(output.series(), scene.output.statistics_from);
  } else {
    run.periods = summarise_periods(output.series(), scene.time.steps_per_period);
  }
  return run;
}

std::string statistics_text(const std::vector<ColumnStatistics>& statistics) {
  std::vector<std::vector<std::string>> rows;
  for (const ColumnStatistics& one : statistics) {
    rows.push_back({one.column, plain_number(one.last), plain_number(one.mean), plain_number(one.amplitude),
                    one.oscillations == 0 ? "-" : plain_number(one.frequency_Hz),
                    plain_number(one.mean_change), plain_number(one.amplitude_change)});
  }
  return text_table(
      {"column", "last", "mean", "amplitude", "frequency (Hz)", "change of mean", "change of amplitude"},
      rows);
}

/// Statistics of a signal that still grows are those of the window.
void warn_of_unsettled(const std::vector<ColumnStatistics>& statistics) {
  const auto columns = unsettled_columns(statistics);
  if (columns.empty()) {
    return;
  }
  constexpr std::size_t most = 6;
  std::string names;
  for (std::size_t i = 0; i < std::min(most, columns.size()); ++i) {
    names += (i == 0 ? "" : ", ") + columns[i];
  }
  spdlog::warn(
      "the statistics of {} of {} columns still change by more than 5 % between the last two oscillations or "
      "the "
      "halves of the window: {}{}; a later output.statistics_from_s or time.end_s",
      columns.size(), statistics.size(), names, columns.size() > most ? ", ..." : "");
}

/// Says where the velocity that convects was extrapolated too far: the answer can be wrong by any factor.
void warn_of_extrapolation(const Scene& scene, const SolvedRun& run) {
  constexpr double far = 0.05; // of the kinetic energy's root; at 0.25 a drag was ten times too high
  if (scene.time.convection.tolerance > 0) {
    return;
  }
  double error = run.periods.empty() ? 0.0 : run.periods.back().convection_error;
  for (const ColumnStatistics& one : run.statistics) {
    if (one.column == "convection_error") {
      error = one.mean;
    }
  }
  if (error > far) {
    spdlog::warn(
        "the velocity that convects is extrapolated, and off by {} % on average: the flow can be wrong; "
        "time.convection_tolerance = 0.001, or shorter steps",
        decimals(100 * error, 1));
  }
}

std::vector<double> flows_of(const std::vector<PeriodSummary>& periods) {
  std::vector<double> flows;
  for (const PeriodSummary& period : periods) {
    flows.push_back(period.outflow_l_per_min);
  }
  return flows;
}

/// "mean of the last 5 periods: 2.41 l/min, standard error 0.05, spread 0.2"
std::string mean_text(const SettledMean& settled) {
  if (!std::isfinite(settled.standard_error)) {
    return "";
  }
  return "mean of the last " + std::to_string(settled.counted) + " periods: " + decimals(settled.mean, 4) +
         " l/min, standard error " + decimals(settled.standard_error, 4) + ", spread " +
         decimals(settled.spread, 4) + "\n";
}

std::string table_text(const SolvedRun& run) {
  if (!run.statistics.empty()) {
    return statistics_text(run.statistics);
  }
  if (!run.periods.empty() && run.periods.front().turn) {
    return turn_table(run.periods);
  }
  std::vector<std::vector<std::string>> rows;
  for (const PeriodSummary& period : run.periods) {
    rows.push_back({std::to_string(period.period), decimals(period.outflow_l_per_min, 4),
                    decimals(period.inflow_l_per_min, 4), decimals(period.spread_l_per_min, 3),
                    decimals(100 * period.energy_gap, 3),
                    std::isfinite(period.scheme_loss) ? decimals(100 * period.scheme_loss, 3) : "-",
                    decimals(period.speed_max_cm_per_s, 1), decimals(period.clearance_min_mm, 4)});
  }
  return text_table({"period", "outflow (l/min)", "inflow (l/min)", "spread (l/min)", "energy gap (%)",
                     "of the scheme (%)", "max speed (cm/s)", "min clearance (mm)"},
                    rows) +
         mean_text(settled_mean(flows_of(run.periods)));
}

std::string json_text(const SolvedRun& run, const PhaseTimer& timer) {
  nlohmann::ordered_json result = {{"scene", run.scene},
                                   {"hash", run.hash},
                                   {"output", run.folder},
                                   {"unknowns", run.unknowns},
                                   {"ranks", run.ranks},
                                   {"first_step", run.first_step},
                                   {"last_step", run.last_step},
                                   {"periods", nlohmann::ordered_json::array()},
                                   {"phases", nlohmann::ordered_json::object()}};
  for (const PeriodSummary& period : run.periods) {
    result["periods"].push_back({{"period", period.period},
                                 {"outflow_l_per_min", period.outflow_l_per_min},
                                 {"inflow_l_per_min", period.inflow_l_per_min},
                                 {"spread_l_per_min", period.spread_l_per_min},
                                 {"input_power_mW", period.input_power_mW},
                                 {"energy_gap", period.energy_gap},
                                 {"speed_max_cm_per_s", period.speed_max_cm_per_s},
                                 {"clearance_min_mm", period.clearance_min_mm}});
    if (period.turn) {
      result["periods"].back()["turn"] = turn_json(*period.turn);
    }
    if (std::isfinite(period.scheme_loss)) {
      result["periods"].back()["scheme_loss"] = period.scheme_loss;
    }
    if (std::isfinite(period.film_elements_min)) {
      result["periods"].back()["film_elements_min"] = period.film_elements_min;
      result["periods"].back()["film_unresolved_percent"] = period.film_unresolved_percent;
    }
  }
  if (!run.periods.empty()) {
    const SettledMean settled = settled_mean(flows_of(run.periods));
    result["settled"] = {{"periods", settled.counted},
                         {"outflow_l_per_min", settled.mean},
                         {"standard_error_l_per_min", finite_or_null(settled.standard_error)},
                         {"spread_l_per_min", settled.spread}};
  }
  for (const ColumnStatistics& one : run.statistics) {
    result["statistics"][one.column] = {{"last", one.last},
                                        {"mean", one.mean},
                                        {"amplitude", one.amplitude},
                                        {"frequency_Hz", one.frequency_Hz},
                                        {"oscillations", one.oscillations},
                                        {"mean_change", one.mean_change},
                                        {"amplitude_change", one.amplitude_change}};
  }
  for (const auto& [phase, record] : timer.records()) {
    result["phases"][phase] = {{"seconds", record.seconds}, {"calls", record.calls}};
  }
  return result.dump(2) + "\n";
}

/// Keeps the state that a run stopped at, and says where. Where it cannot, why is told by what stopped the
/// run.
void keep_state(RunDirectory& output, const State& state) {
  if (!output.has_row_of(state.step)) {
    return;
  }
  try {
    const auto file = output.save_state(state);
    spdlog::error("stopped; the last good state, step {}, is kept in {}", state.step, file.string());
  } catch (const std::exception&) {
    spdlog::error(
        "stopped; the last good state, step {}, could not be kept: --restart goes on from the newest "
        "checkpoint before it",
        state.step);
  }
}

/// Steps from line to line of the log: a period, or a tenth of the run.
long log_interval(const Scene& scene, int steps) {
  return scene.problem.general ? std::max(1, steps / 10) : scene.time.steps_per_period;
}

/// Whether the mean flow is known as well as the scene asks, at the end of a period. `output` on rank 0.
/// Collective.
bool knows_its_flow(const Scene& scene, const std::optional<RunDirectory>& output, const State& state,
                    MPI_Comm comm) {
  if (scene.time.flow_error <= 0 || scene.problem.general || state.step == 0 ||
      state.step % scene.time.steps_per_period != 0) {
    return false;
  }
  int known = 0;
  on_root(comm, [&] {
    const auto flows = flows_of(summarise_periods(output->series(), scene.time.steps_per_period));
    const auto ramped = static_cast<std::size_t>(std::ceil(scene.time.ramp_periods));
    known = flows.size() > ramped && flow_is_known(scene, std::span(flows).subspan(ramped));
    if (known) {
      spdlog::info(
          "the mean flow is known as well as time.flow_error_l_per_min asks: ended after period {} of {}",
          flows.size(), scene.time.periods);
    }
  });
  MPI_Bcast(&known, 1, MPI_INT, 0, comm);
  return known != 0;
}

void solve(const SolveOptions& options, MPI_Comm comm) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);

  // 1. Read the scene; refuse what would be refused later.
  Scene scene = read_scene(options.scene, options.overrides);
  const std::string folder = options.output.empty() ? scene.name + "_run" : options.output;
  if (options.restart) {
    on_root(comm, [&] { keep_reference_velocity(folder, scene); });
    MPI_Bcast(&scene.stabilisation.reference_velocity, 1, MPI_DOUBLE, 0, comm);
  }
  check_checkpoint_interval(scene);
  warn_of_profile(scene);
  const ExistingRun existing = options.restart ? ExistingRun::go_on
                               : options.force ? ExistingRun::replace
                                               : ExistingRun::refuse;
  std::optional<FolderLock> lock; // on rank 0
  on_root(comm, [&] {
    lock.emplace(folder, "undula solve " + options.scene);
    if (!lock->held()) {
      spdlog::warn("{} is on a file system without locks: nothing keeps a second run out", folder);
    }
    check_run_directory(folder, scene, existing);
  });

  // 2. Prepare what the scene's level needs: meshes, cut, operators, or coefficients.
  PhaseTimer timer;
  const auto level = prepare_level(scene, comm, timer);

  // 3. The output, and the state to go on from.
  State state = level->initial_state();
  std::optional<RunDirectory> output; // on rank 0
  on_root(comm, [&] {
    const auto scope = timer.measure("output");
    output.emplace(folder, level->view(scene), scene, existing, ranks, state);
    for (const std::string& message : output->damaged()) {
      spdlog::warn("an older checkpoint is used: {}", message);
    }
    if (options.restart) {
      spdlog::info("{} goes on from step {}", folder, state.step);
    }
  });
  broadcast_state(comm, state);
  const int first_step = state.step;

  // 4. March. Where the numerics fail, the last good state stays; where a signal comes, the next one does.
  const int last = last_step(scene), steps = last - first_step;
  try {
    const StopSignal stop;
    std::optional<Progress> progress;
    if (rank == 0) {
      progress.emplace("solve", std::max(steps, 0), log_interval(scene, steps));
    }
    march(
        *level, scene, state, timer,
        [&](const State& now, const Observation& seen) {
          const auto scope = timer.measure("output");
          on_root(comm, [&] {
            output->record(now, seen);
            progress->update(now.step - first_step);
          });
          const int signal = stop.agreed(comm);
          if (signal == 0 || now.step == last) {
            return;
          }
          std::string file;
          on_root(comm, [&] { file = output->save_state(now).string(); });
          const bool repeats = now.step % scene.time.factor_every == 0;
          throw Stopped("stopped by " + signal_name(signal) + " after step " + std::to_string(now.step) +
                        " of " + std::to_string(last) + "\n  kept in: " + file + "\n  go on with --restart" +
                        (repeats ? "" : " (not bit for bit: time.factor_every > 1)"));
        },
        [&](const State& now) { return knows_its_flow(scene, output, now, comm); });
  } catch (const NumericsError&) {
    if (rank == 0) {
      keep_state(*output, state);
    }
    throw;
  }

  // 5. Write.
  on_root(comm, [&] {
    output->finish(state, timer);
    const SolvedRun run = summary(scene, *output, level->unknowns(), ranks, first_step, state.step);
    if (scene.coupling == Coupling::fixed && !run.periods.empty() &&
        run.periods.back().clearance_min_mm < 0) {
      spdlog::warn(
          "the membrane passes through a wall, which fixed coupling does not feel; "
          "the geometry is that of rest");
    }
    if (!run.periods.empty() && run.periods.back().film_unresolved_percent > 0) {
      spdlog::warn("in the last period {}", film_remark(run.periods.back().film_unresolved_percent,
                                                        run.periods.back().film_elements_min));
    }
    warn_of_extrapolation(scene, run);
    warn_of_unsettled(run.statistics);
    std::cout << (options.json ? json_text(run, timer) : table_text(run));
    if (options.plot) {
      plot_run(drawn_run(*output), scene, state);
    }
  });
}

} // namespace

void add_solve_command(CLI::App& app) {
  auto options = std::make_shared<SolveOptions>();
  CLI::App* command = app.add_subcommand("solve", "Run the full-order model of a scene");
  command->add_option("scene", options->scene, "scene file (TOML)")->required();
  command->add_option("--set", options->overrides, "override a key: section.key=value, may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_option("--output", options->output, "folder for everything the run writes; default NAME_run");
  CLI::Option* restart =
      command->add_flag("--restart", options->restart, "go on from the newest checkpoint in the folder");
  command->add_flag("--force", options->force, "remove the run that is in the folder and start anew")
      ->excludes(restart);
  command->add_flag("--plot", options->plot, "draw pictures of the flow and the membrane into the folder");
  command->add_flag("--json", options->json, "print JSON");
  command->add_option("petsc", options->petsc, "options for PETSc, after --");
  command->footer(scene_keys_help());
  command->callback(
      [options] { run_parallel(options->petsc, [&](MPI_Comm comm) { solve(*options, comm); }); });
}

} // namespace undula::apps
