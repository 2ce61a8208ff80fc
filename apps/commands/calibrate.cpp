// undula calibrate scene.toml --data measured.csv --free key=low:high --output calibrated.toml: values of
// free keys that bring the head-flow curves of a scene closest to measured ones.
//   undula calibrate data/scenes/wave_pump_thin_gap.toml --data data/measured/corwave_120hz_0.53mm.csv
//     --free geometry.rim_gap_scale=0.8:1.2 --free operating_point.stroke_scale=0.95:1.05
//     --output calibrated.toml --plot calibration.png
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

#include "apps/apps.hpp"
#include "apps/commands/commands.hpp"
#include "apps/input/head_list.hpp"
#include "apps/input/target_curves.hpp"
#include "apps/mpi_session.hpp"
#include "apps/output/calibration_report.hpp"
#include "apps/output/gnuplot.hpp"
#include "apps/output/progress.hpp"
#include "apps/output/text_table.hpp"
#include "fom/levels/emulated_level.hpp"
#include "fom/output/root_rank.hpp"
#include "fom/output/scene_difference.hpp"
#include "fom/scene/common_problem.hpp"
#include "fom/scene/scene_file.hpp"
#include "fom/scene/scene_tolerance.hpp"
#include "fom/scene/scene_value.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"
#include "training/calibration/uncertainty.hpp"
#include "training/sampling/key_range.hpp"

namespace undula::apps {
namespace {

struct CalibrateOptions {
  std::string scene;
  std::string by; ///< emulator that answers for the scene; empty: the scene's own level
  std::vector<std::string> overrides;
  std::vector<std::string> data;
  DataSetting setting;
  std::vector<std::string> free, profiles;
  bool tolerances = false;
  std::string output;
  bool force = false;
  int points = 8;
  std::string picture;
  bool json = false;
  std::vector<std::string> petsc;
};

/// "geometry.rim_gap_scale=0.8:1.2"
FreeKey parse_free_key(const std::string& text) {
  const auto range = read_key_range(text);
  if (!range) {
    throw InputError("a free key cannot be read", '"' + text + '"',
                     "section.key=low:high, for instance operating_point.stroke_scale=0.95:1.05", "--free");
  }
  FreeKey key;
  key.key = range->key, key.low = range->low, key.high = range->high;
  return key;
}

/// "actuator.suspension_N_per_mm=10:40:7"
ProfileRequest parse_profile(const std::string& text) {
  const auto colon = text.rfind(':');
  const auto count =
      colon == std::string::npos ? std::nullopt : read_finite(std::string_view(text).substr(colon + 1));
  if (!count || *count < 2 || *count > 1000 || *count != std::floor(*count)) {
    throw InputError("a profile cannot be read", '"' + text + '"',
                     "section.key=low:high:values, for instance actuator.suspension_N_per_mm=10:40:7",
                     "--profile");
  }
  const FreeKey range = parse_free_key(text.substr(0, colon));
  return {range.key, even_heads(range.low, range.high, static_cast<int>(*count))};
}

/// A profile of a key that is fitted, with others beside it.
void check_profile(const Scene& scene, std::span<const FreeKey> keys, const ProfileRequest& request) {
  if (std::ranges::none_of(keys, [&](const FreeKey& key) { return key.key == request.key; }) ||
      keys.size() < 2) {
    throw InputError("a profile is that of one fitted key among others", request.key,
                     "a key of --free, or one with a tolerance and --tolerances", "--profile");
  }
  for (const double value : request.values) {
    with_value(scene, request.key, value); // refuses values out of the key's range
  }
}

void check_output(const CalibrateOptions& options) {
  const std::filesystem::path output(options.output);
  const auto folder = std::filesystem::absolute(output).parent_path();
  std::error_code ignored;
  if (output.extension() != ".toml" || !std::filesystem::is_directory(folder, ignored)) {
    throw InputError("the calibrated scene cannot be written", options.output,
                     "a name that ends in .toml, in an existing folder", "--output");
  }
  if (std::filesystem::exists(output, ignored) && !options.force) {
    throw InputError("the calibrated scene would replace a file", options.output,
                     "another name, or --force to replace it", "--output");
  }
}

/// The emulator of --by. Throws InputError unless it was made of runs of this scene, up to what is its input,
/// and knows the free keys.
rom::Emulator read_answering_emulator(const std::string& file, const Scene& scene,
                                      std::span<const FreeKey> keys) {
  if (!rom::holds_emulator(file)) {
    throw InputError("only an emulator answers for the values of a scene", file,
                     "an emulator that undula train made (training.model = \"emulator\")", "--by");
  }
  rom::Emulator emulator = rom::load_emulator(file);
  const auto known = emulated_keys(emulator);
  const auto is_known = [&](const std::string& key) { return std::ranges::find(known, key) != known.end(); };
  for (const FreeKey& key : keys) {
    if (!is_known(key.key)) {
      std::string allowed;
      for (const std::string& one : known) {
        allowed += (allowed.empty() ? "" : ", ") + one;
      }
      throw InputError("the emulator has no such input", key.key,
                       allowed.empty() ? "an emulator trained with training.vary" : allowed, "--by " + file);
    }
  }
  const auto of_runs = emulator.provenance.find("scene");
  auto differences =
      differing_keys(of_runs == emulator.provenance.end() ? "" : of_runs->second, scene_to_toml(scene));
  std::erase_if(differences, [&](const KeyDifference& one) {
    return is_known(one.key) || one.key == "name" || one.key == "geometry.profile" ||
           one.key.starts_with("operating_point.") || one.key.starts_with("output.") ||
           one.key.starts_with("training.");
  });
  if (!differences.empty()) {
    throw InputError("the emulator is of runs of another scene", difference_text(differences),
                     "the scene of its campaign, or an emulator of this one", "--by " + file);
  }
  return emulator;
}

/// The largest error that the emulator states of a computed flow.
double largest_stated_error(Level& level, const Scene& scene, std::span<const TargetCurve> targets) {
  double largest = 0;
  for (const TargetCurve& target : targets) {
    for (const CurvePoint& point : level.curve(at_setting(scene, target), target.head_mmHg)) {
      largest = std::max(largest, point.error_l_per_min);
    }
  }
  return largest;
}

void run_calibration(const CalibrateOptions& options, MPI_Comm comm) {
  // 1. Everything that may be wrong with the input comes before the first result.
  check_output(options);
  if (!options.picture.empty()) {
    check_picture_name(options.picture);
  }
  const Scene scene = read_scene(options.scene, options.overrides);
  require_wave_pump(scene, "undula calibrate");
  std::vector<FreeKey> keys;
  for (const std::string& text : options.free) {
    keys.push_back(parse_free_key(text));
  }
  if (options.tolerances) {
    check_tolerances(scene);
    const auto held = held_keys(scene, keys);
    keys.insert(keys.end(), held.begin(), held.end());
  }
  if (keys.empty()) {
    throw InputError("nothing is free to be fitted", "neither --free nor --tolerances", "one of them",
                     "command line");
  }
  check_free_keys(scene, keys);
  std::vector<ProfileRequest> requests;
  for (const std::string& text : options.profiles) {
    requests.push_back(parse_profile(text));
    check_profile(scene, keys, requests.back());
  }
  std::vector<MeasuredCurve> measured;
  for (const std::string& file : options.data) {
    measured.push_back(read_measured_curve(file));
  }
  const std::vector<TargetCurve> targets =
      target_curves(scene, options.data, measured, options.setting, options.points);

  std::optional<rom::Emulator> emulator;
  LevelOfScene level_of;
  if (!options.by.empty()) {
    emulator = read_answering_emulator(options.by, scene, keys);
    level_of = [&emulator](const Scene&) { return std::make_unique<EmulatedLevel>(*emulator); };
  }

  // 2. The fit: every set of values gives all curves.
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  Calibration calibration;
  {
    const FitOptions fit;
    std::optional<Progress> progress;
    if (rank == 0) {
      progress.emplace("calibrate (at most)", static_cast<long>(keys.size()) * (fit.most_points_per_key + 2));
    }
    const auto on_refusal = [&](const std::string& reason) {
      if (!options.json) {
        spdlog::warn("refused a set of values: {}", reason);
      }
    };
    const FlowsOfValues flows = flows_of_scene(scene, keys, targets, comm, on_refusal, level_of);
    long done = 0;
    calibration = calibrate(
        [&](const Eigen::VectorXd& values) {
          const auto computed = flows(values);
          ++done;
          if (progress) {
            progress->update(done);
          }
          return computed;
        },
        keys, values_of(scene, keys), targets, fit);
  }

  // 3. What each asked key may be without a worse fit.
  std::vector<KeyProfile> profiles;
  {
    std::optional<Progress> progress;
    long values = 0, done = 0;
    for (const ProfileRequest& request : requests) {
      values += static_cast<long>(request.values.size());
    }
    if (rank == 0 && values > 0) {
      progress.emplace("profile", values);
    }
    for (const ProfileRequest& request : requests) {
      const FlowsAtValue flows = [&](double value, std::span<const FreeKey> others) {
        return flows_of_scene(with_value(scene, request.key, value), others, targets, comm, {}, level_of);
      };
      profiles.push_back(
          {request.key, profile_likelihood(flows, request, keys, calibration.optimum, targets, [&] {
             ++done;
             if (progress) {
               progress->update(done);
             }
           })});
    }
  }

  // 4. The scene and the numbers; the picture beside them.
  on_root(comm, [&] {
    Scene calibrated = with_values(scene, keys, calibration.optimum);
    calibrated.name = std::filesystem::path(options.output).stem().string();
    for (const FreeKey& key : keys) {
      narrow_tolerance(calibrated, key.key);
    }
    if (emulator) {
      EmulatedLevel level(*emulator);
      spdlog::warn(
          "the flows are the emulator's, which states errors of up to {} l/min of them; a run of the "
          "scene confirms: undula hq {}",
          decimals(largest_stated_error(level, calibrated, targets), 2), options.output);
    }
    const CalibrationReport report = {calibrated, keys, targets, calibration, profiles};
    const auto folder = std::filesystem::absolute(options.output).parent_path();
    replace_text_file(options.output, calibrated_scene_text(report, folder));
    std::cout << (options.json ? calibration_json(report) : calibration_table(report));
    if (!options.picture.empty()) {
      plot_calibration(options.picture, report, measured);
    }
  });
}

} // namespace

void add_calibrate_command(CLI::App& app) {
  auto options = std::make_shared<CalibrateOptions>();
  CLI::App* command = app.add_subcommand(
      "calibrate", "Fit keys of a scene to measured head-flow curves (docs/calibration.md)");
  command->add_option("scene", options->scene, "scene file (TOML)")->required();
  command->add_option("--by", options->by,
                      "emulator (.h5) of this scene that answers in its place; fits its inputs");
  command
      ->add_option("--data", options->data,
                   "measured points (CSV: head_mmHg,flow_l_per_min), may be repeated")
      ->required()
      ->allow_extra_args(false);
  command
      ->add_option("--free", options->free,
                   "a key to fit and its range in the key's unit, section.key=low:high, may be repeated")
      ->type_name("KEY=LOW:HIGH")
      ->allow_extra_args(false);
  command->add_flag("--tolerances", options->tolerances,
                    "fit every input that states a tolerance as well, held by it");
  command
      ->add_option("--profile", options->profiles,
                   "after the fit: the best misfit with this key held at values of a range, may be repeated")
      ->type_name("KEY=LOW:HIGH:VALUES")
      ->allow_extra_args(false);
  command->add_option("--output", options->output, "the calibrated scene (.toml)")->required();
  command->add_flag("--force", options->force, "replace an existing output");
  command->add_option("--points", options->points, "heads per curve, spread over the measured range")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--frequency", options->setting.frequency_Hz,
                   "frequency of the data, Hz, in place of the file's")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--stroke", options->setting.stroke_mm, "stroke of the data, mm, in place of the file's")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--voltage", options->setting.voltage_V, "voltage of the data, V, in place of the file's")
      ->check(CLI::PositiveNumber);
  command->add_option("--plot", options->picture, "picture to draw (.png)");
  command->add_flag("--json", options->json, "print JSON");
  command->add_option("--set", options->overrides, "override a key, section.key=value, may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_option("petsc", options->petsc, "options for PETSc, after --");
  command->callback(
      [options] { run_parallel(options->petsc, [&](MPI_Comm comm) { run_calibration(*options, comm); }); });
}

} // namespace undula::apps
