// undula train scene.toml: full-order runs over the box of the scene, and the reduced model or emulator made
// from them.
//   undula train data/scenes/wave_pump_fixed.toml --output model.h5
//   mpirun -np 2 undula train data/scenes/wave_pump_fixed.toml --output model.h5 --campaign runs
//   undula train data/scenes/wave_pump_fixed.toml --campaign runs --output model.h5 --json
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/apps.hpp"
#include "apps/commands/commands.hpp"
#include "apps/mpi_session.hpp"
#include "apps/output/emulator_report.hpp"
#include "apps/output/moving_model_report.hpp"
#include "apps/output/progress.hpp"
#include "apps/output/text_table.hpp"
#include "apps/stop_signal.hpp"
#include "fom/output/provenance.hpp"
#include "fom/output/root_rank.hpp"
#include "fom/output/scene_difference.hpp"
#include "fom/scene/scene_checks.hpp"
#include "fom/scene/scene_file.hpp"
#include "fom/scene/scene_reference.hpp"
#include "rom/base/error.hpp"
#include "rom/base/replaced_file.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"
#include "training/campaign/campaign.hpp"
#include "training/campaign/run_record_file.hpp"
#include "training/emulation/build_emulator.hpp"
#include "training/emulation/fit_responses.hpp"
#include "training/emulation/next_points.hpp"
#include "training/moving_domain/build_moving_model.hpp"
#include "training/reduction/build_model.hpp"
#include "training/sampling/trainable_scene.hpp"
#include "training/sampling/varied_keys.hpp"

namespace undula::apps {
namespace {

struct TrainOptions {
  std::string scene;
  std::vector<std::string> overrides;
  std::string output;
  std::string campaign;
  std::optional<double> tolerance; ///< l/min
  int most_runs = 100;
  bool with_recorded = false;
  bool fields = false;
  bool force = false;
  bool json = false;
  std::vector<std::string> petsc;
};

std::string point_text(const OperatingPoint& point) {
  const std::string drive = point.drive == Drive::voltage
                                ? plain_number(point.voltage) + " V, "
                                : plain_number(units::length_to_mm(point.stroke)) + " mm, ";
  std::string text = plain_number(point.frequency) + " Hz, " + drive +
                     plain_number(units::pressure_to_mmHg(point.head)) + " mmHg";
  for (const auto& [key, value] : point.varied) {
    text += ", " + key + " = " + plain_number(value);
  }
  return text;
}

std::string mode_text(const TrainedModel& trained) {
  std::vector<std::vector<std::string>> rows;
  for (const ModeRow& row : trained.modes) {
    rows.push_back({std::to_string(row.velocity_modes) + "+" + std::to_string(row.supremizers),
                    std::to_string(row.pressure_modes), std::to_string(row.displacement_modes),
                    decimals(units::flow_to_l_per_min(row.flow_worst), 4),
                    decimals(100 * row.flow_worst / trained.flow_range, 3),
                    decimals(100 * row.velocity_mean, 3), decimals(100 * row.velocity_worst, 3),
                    decimals(100 * row.best_velocity_worst, 3), decimals(100 * row.envelope_worst, 3),
                    decimals(row.milliseconds, 2), std::to_string(row.not_converged)});
  }
  return text_table({"velocity modes", "pressure", "displacement", "flow, worst (l/min)", "of the range (%)",
                     "velocity, mean (%)", "worst (%)", "basis, worst (%)", "envelope, worst (%)",
                     "ms per point", "not converged"},
                    rows);
}

std::string run_text(const TrainedModel& trained) {
  std::vector<std::vector<std::string>> rows;
  for (const rom::ReferencePoint& run : trained.model.references) {
    rows.push_back({run.held_out ? "held out" : "training", plain_number(run.frequency_Hz),
                    decimals(run.stroke_mm, 3), decimals(run.head_mmHg, 2), decimals(run.flow_l_per_min, 4),
                    decimals(run.rom_flow_l_per_min, 4), decimals(100 * run.velocity_error, 3),
                    decimals(100 * run.envelope_error, 3), decimals(run.fom_seconds, 1)});
  }
  return text_table({"run", "f (Hz)", "stroke (mm)", "head (mmHg)", "flow FOM (l/min)", "flow ROM (l/min)",
                     "velocity error (%)", "envelope error (%)", "FOM (s)"},
                    rows);
}

nlohmann::ordered_json to_json(const TrainedModel& trained, const std::string& file) {
  nlohmann::ordered_json result = {{"model", file},
                                   {"flow_range_l_per_min", units::flow_to_l_per_min(trained.flow_range)},
                                   {"error_safety", trained.model.error_safety},
                                   {"error_floor_l_per_min", trained.model.error_floor_l_per_min},
                                   {"left_out", trained.left_out},
                                   {"modes", nlohmann::ordered_json::array()},
                                   {"runs", nlohmann::ordered_json::array()}};
  for (const ModeRow& row : trained.modes) {
    result["modes"].push_back({{"velocity_modes", row.velocity_modes},
                               {"supremizers", row.supremizers},
                               {"pressure_modes", row.pressure_modes},
                               {"displacement_modes", row.displacement_modes},
                               {"flow_worst_l_per_min", units::flow_to_l_per_min(row.flow_worst)},
                               {"velocity_mean", row.velocity_mean},
                               {"velocity_worst", row.velocity_worst},
                               {"best_velocity_worst", row.best_velocity_worst},
                               {"envelope_worst", row.envelope_worst},
                               {"milliseconds", row.milliseconds},
                               {"not_converged", row.not_converged}});
  }
  for (const rom::ReferencePoint& run : trained.model.references) {
    result["runs"].push_back({{"held_out", run.held_out},
                              {"frequency_Hz", run.frequency_Hz},
                              {"stroke_mm", run.stroke_mm},
                              {"head_mmHg", run.head_mmHg},
                              {"flow_l_per_min", run.flow_l_per_min},
                              {"rom_flow_l_per_min", run.rom_flow_l_per_min},
                              {"velocity_error", run.velocity_error},
                              {"envelope_error", run.envelope_error},
                              {"fom_seconds", run.fom_seconds}});
  }
  return result;
}

/// The scene as a model tells it: by the name of its profile, not by the place that it had on this machine.
std::string told_scene(Scene scene) {
  scene.profile = scene.profile.filename();
  return scene_to_toml(scene);
}

/// Throws InputError unless the file is missing, or the model of the same scene, or a model that --force
/// gives up.
void check_target(const std::string& file, const Scene& scene, bool force) {
  if (!std::filesystem::exists(file)) {
    return;
  }
  std::string seen = "a file that is no reduced model";
  try {
    const auto provenance = rom::holds_emulator(file)       ? rom::load_emulator(file).provenance
                            : rom::holds_moving_model(file) ? rom::load_moving_model(file).provenance
                                                            : rom::load_model(file).provenance;
    const auto entry = [&](const char* name) {
      const auto found = provenance.find(name);
      return found == provenance.end() ? std::string() : found->second;
    };
    auto differences = differing_keys(entry("scene"), told_scene(scene));
    // Files of older versions tell the place; the hash knows the content.
    std::erase_if(differences, [](const KeyDifference& one) { return one.key == "geometry.profile"; });
    if (force || (differences.empty() && entry("scene_hash") == scene_hash(scene))) {
      return;
    }
    seen = "a model of another scene; " + difference_text(differences);
  } catch (const InputError& error) {
    seen += std::string(": ") + error.what();
  }
  throw InputError("train does not replace what another scene or program made", seen,
                   "another --output; for a model also --force", file);
}

/// Computes the points without a record. A signal ends the run at hand: throws Stopped, with the records
/// stored.
void compute_runs(const Scene& scene, std::span<const OperatingPoint> points, const CampaignStore& store,
                  const std::string& folder, MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  const auto work = [&](const AfterStep& after_step) {
    std::optional<Progress> progress;
    if (rank == 0) {
      progress.emplace("train", static_cast<long>(points.size()));
    }
    const auto tell = [&](const RunRecord& run, std::size_t done, std::size_t total) {
      if (progress) {
        progress->update(static_cast<long>(done));
      }
      const std::string periods = std::to_string(run.cycles.periods.size()) + " periods";
      const std::string outcome = run.state == RunState::periodic  ? "periodic after " + periods
                                  : run.state == RunState::settled ? "mean known after " + periods
                                                                   : run.reason;
      spdlog::info("{}/{}  {}: {} ({} s)", done, total, point_text(run.point), outcome,
                   decimals(run.seconds.at("total"), 1));
    };
    run_campaign(scene, points, store, comm, tell, after_step);
  };
  run_until_signal(comm, work, [&](const std::string& signal) {
    return "stopped by " + signal + " with " +
           std::to_string(points.size() - store.status(points).pending.size()) + " of " +
           std::to_string(points.size()) + " runs stored in " + folder +
           "\n  the same command goes on with the others";
  });
}

/// Points as numbers, for the other ranks.
std::vector<OperatingPoint> shared(const std::vector<OperatingPoint>& on_root, const Scene& scene,
                                   MPI_Comm comm) {
  // The keys that all points vary, or none of those at the scene's own values.
  const auto keys = varied_keys(scene);
  std::vector<double> numbers;
  for (const OperatingPoint& at : on_root) {
    numbers.insert(numbers.end(), {at.frequency, at.stroke, at.voltage, at.head});
    for (const VariedKey& key : keys) {
      const auto there = at.varied.find(key.key);
      numbers.push_back(there != at.varied.end() ? there->second : std::nan(""));
    }
  }
  int size = static_cast<int>(numbers.size());
  MPI_Bcast(&size, 1, MPI_INT, 0, comm);
  numbers.resize(static_cast<std::size_t>(size));
  MPI_Bcast(numbers.data(), size, MPI_DOUBLE, 0, comm);
  std::vector<OperatingPoint> points;
  for (std::size_t k = 0; k < numbers.size(); k += 4 + keys.size()) {
    OperatingPoint at = scene.operating_point;
    at.frequency = numbers[k], at.stroke = numbers[k + 1], at.voltage = numbers[k + 2],
    at.head = numbers[k + 3];
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (const double value = numbers[k + 4 + i]; std::isfinite(value)) {
        at.varied[keys[i].key] = value;
      }
    }
    points.push_back(at);
  }
  return points;
}

/// Adds runs to `plan` and `points` where the emulator's stated error is largest, until it is within the
/// tolerance over the box or the runs are as many as allowed.
void add_runs(const TrainOptions& options, const Scene& scene, const CampaignStore& store,
              const std::string& folder, MPI_Comm comm, SamplingPlan& plan,
              std::vector<OperatingPoint>& points) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  const int groups = std::max(1, ranks / scene.training.ranks_per_run);
  const auto flow_alone = std::span(rom::emulated_columns).first(1);
  while (true) {
    std::vector<OperatingPoint> wanted;
    on_root(comm, [&] {
      if (!store.status(points).pending.empty()) {
        return;
      }
      const auto next =
          next_points(build_emulator(scene, plan, store, flow_alone).emulator, scene, points, groups);
      const int left = options.most_runs - static_cast<int>(points.size());
      spdlog::info("{} runs: largest stated error of the box {} l/min", points.size(),
                   decimals(next.largest_error, 4));
      if (next.largest_error <= *options.tolerance) {
        return;
      }
      if (left <= 0) {
        spdlog::warn("the error asked for, {} l/min, is not reached with {} runs: more --runs",
                     plain_number(*options.tolerance), points.size());
        return;
      }
      wanted = next.points;
      wanted.resize(std::min(wanted.size(), static_cast<std::size_t>(left)));
    });
    wanted = shared(wanted, scene, comm);
    if (wanted.empty()) {
      return;
    }
    plan.training.insert(plan.training.end(), wanted.begin(), wanted.end());
    points.insert(points.end(), wanted.begin(), wanted.end());
    compute_runs(scene, points, store, folder, comm);
  }
}

/// Runs in the box that are recorded besides the plan, as those of `hq --tolerance`.
std::vector<OperatingPoint> recorded_besides(const Scene& scene, const CampaignStore& store,
                                             const SamplingPlan& plan) {
  std::vector<OperatingPoint> besides;
  const auto planned = [&](const OperatingPoint& point) {
    const auto same = [&](const OperatingPoint& other) { return same_point(point, other); };
    return std::ranges::any_of(plan.training, same) || std::ranges::any_of(plan.held_out, same);
  };
  std::vector<std::string> damaged;
  const auto recorded = store.recorded_points(damaged);
  for (const std::string& message : damaged) {
    spdlog::warn("{}", message);
  }
  const auto varied = varied_keys(scene);
  for (const OperatingPoint& point : recorded) {
    if (point.drive == scene.operating_point.drive && is_inside(scene.training, point, varied) &&
        !planned(point)) {
      besides.push_back(point);
    }
  }
  return besides;
}

void train(const TrainOptions& options, MPI_Comm comm) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);

  // 1. The scene, the plan, and the folder of the runs.
  const Scene scene = read_scene(options.scene, options.overrides);
  require_trainable(scene);
  check_training(scene, scene.file.string());
  const std::vector<VariedKey> varied = varied_keys(scene);
  const std::string output = options.output.empty() ? scene.name + ".h5" : options.output;
  on_root(comm, [&] {
    check_target(output, scene, options.force);
    remove_leftovers_of(output);
  });
  const std::string folder = options.campaign.empty() ? output + ".runs" : options.campaign;
  const bool emulated = scene.training.model == ModelKind::emulator;
  if (options.tolerance && !emulated) {
    throw InputError("a projected model does not choose its runs", "--tolerance",
                     "training.model = \"emulator\"", scene.file.string());
  }
  const bool moving = !emulated && has_mapped_domain(scene);
  if (options.fields && (emulated || moving)) {
    throw InputError("this model keeps no fields",
                     emulated ? "an emulator, which knows means alone" : "a model of a moving domain",
                     "--fields with a projected model of a fixed domain", "--fields");
  }
  SamplingPlan plan =
      plan_samples(scene.training, emulated || moving ? scene.operating_point : OperatingPoint{}, varied);
  std::optional<CampaignStore> store;
  std::vector<OperatingPoint> besides;
  on_root(comm, [&] {
    store = CampaignStore::of_scene(folder, scene);
    if (options.with_recorded) {
      besides = recorded_besides(scene, *store, plan);
    }
  });
  besides = shared(besides, scene, comm);
  plan.training.insert(plan.training.end(), besides.begin(), besides.end());
  std::vector<OperatingPoint> points = plan.training;
  points.insert(points.end(), plan.held_out.begin(), plan.held_out.end());
  on_root(comm, [&] {
    for (const std::string& message : store->status(points).damaged) {
      spdlog::warn("{}", message);
    }
  });
  if (rank != 0) {
    store = CampaignStore::of_scene(folder, scene);
  }

  // 2. The full-order runs that are not there yet.
  compute_runs(scene, points, *store, folder, comm);
  if (options.tolerance) {
    add_runs(options, scene, *store, folder, comm, plan, points);
  }

  // 3. The reduced model, by one rank, unless another process still computes.
  on_root(comm, [&] {
    const auto pending = store->status(points).pending;
    if (!pending.empty()) {
      spdlog::warn("{} points are being computed by other processes: call again when they have ended",
                   pending.size());
      return;
    }
    auto origin = provenance(ranks);
    origin["scene"] = told_scene(scene);
    origin["scene_hash"] = scene_hash(scene);
    if (emulated) {
      BuiltEmulator built = build_emulator(scene, plan, *store);
      PhaseTimer timer;
      add_responses(built, scene, plan, *store, timer);
      built.emulator.provenance = origin;
      rom::save_emulator(built.emulator, output);
      for (const std::string& message : built.not_used) {
        spdlog::warn("not used: {}", message);
      }
      std::cout << (options.json ? emulator_json(built, output) : emulator_text(built, output));
      return;
    }
    PhaseTimer timer;
    if (moving) {
      BuiltMovingModel built = build_moving_model(scene, plan, *store, timer);
      built.model.provenance = origin;
      rom::save_moving_model(built.model, output);
      for (const std::string& message : built.left_out) {
        spdlog::warn("left out, failed: {}", message);
      }
      if (const double error = std::max(built.cubature.part_error, built.cubature.cell_error);
          error > scene.training.cubature_error) {
        spdlog::warn("the cubature misses {} of the forces, more than training.cubature_error allows, {}",
                     plain_number(error), plain_number(scene.training.cubature_error));
      }
      std::cout << (options.json ? moving_model_json(built, output) : moving_model_text(built, output));
      return;
    }
    TrainedModel trained = build_model(scene, plan, *store, timer, options.fields);
    trained.model.provenance = origin;
    if (trained.fields) {
      rom::save_model(trained.model, output, *trained.fields);
    } else {
      rom::save_model(trained.model, output);
    }
    for (const std::string& message : trained.left_out) {
      spdlog::warn("left out, not periodic: {}", message);
    }
    if (options.json) {
      std::cout << to_json(trained, output).dump(2) << "\n";
      return;
    }
    std::cout << run_text(trained) << "\nheld-out runs, by size of the model:\n"
              << mode_text(trained)
              << "\nflow range of the box: " << decimals(units::flow_to_l_per_min(trained.flow_range), 3)
              << " l/min\nwritten: " << output << "\n";
  });
}

} // namespace

void add_train_command(CLI::App& app) {
  auto options = std::make_shared<TrainOptions>();
  CLI::App* command =
      app.add_subcommand("train", "Run the full-order model over a box and make a reduced model from it");
  command->add_option("scene", options->scene, "scene file (TOML)")->required();
  command->add_option("--set", options->overrides, "override a key: section.key=value, may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_option("--output", options->output, "model file to write; default NAME.h5");
  command->add_option("--campaign", options->campaign,
                      "folder of the full-order runs, resumed if it exists; default OUTPUT.runs");
  command
      ->add_option(
          "--tolerance", options->tolerance,
          "emulators: add runs where the stated error of the flow is largest, until it is below this, l/min")
      ->check(CLI::PositiveNumber);
  command->add_option("--runs", options->most_runs, "most runs that --tolerance may come to; default 100")
      ->check(CLI::Range(1, 100000))
      ->needs("--tolerance");
  command->add_flag(
      "--with-recorded", options->with_recorded,
      "train also with the runs of the folder that are not in the plan, as those of hq --tolerance");
  command->add_flag(
      "--fields", options->fields,
      "projected models of fixed domains: keep mesh and modes in the file, to draw fields from it");
  command->add_flag("--force", options->force, "replace a model of another scene in OUTPUT");
  command->add_flag("--json", options->json, "print JSON");
  command->add_option("petsc", options->petsc, "options for PETSc, after --");
  command->footer(scene_keys_help());
  command->callback(
      [options] { run_parallel(options->petsc, [&](MPI_Comm comm) { train(*options, comm); }); });
}

} // namespace undula::apps
