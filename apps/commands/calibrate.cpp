// undula calibrate scene.toml --data measured.csv --free key=low:high --output calibrated.toml: values of
// free keys that bring the head-flow curves of a scene closest to measured ones.
//   undula calibrate data/scenes/wave_pump_thin_gap.toml --data data/measured/corwave_120hz_0.53mm.csv
//     --free geometry.rim_gap_scale=0.8:1.2 --free operating_point.stroke_scale=0.95:1.05
//     --output calibrated.toml --plot calibration.png
#include <spdlog/spdlog.h>

#include <charconv>
#include <cmath>
#include <iostream>
#include <memory>

#include "apps/apps.hpp"
#include "apps/commands/commands.hpp"
#include "apps/input/head_list.hpp"
#include "apps/mpi_session.hpp"
#include "apps/output/calibration_report.hpp"
#include "apps/output/gnuplot.hpp"
#include "apps/output/progress.hpp"
#include "apps/output/text_table.hpp"
#include "fom/output/root_rank.hpp"
#include "fom/scene/common_problem.hpp"
#include "fom/scene/scene_file.hpp"
#include "fom/scene/scene_tolerance.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::apps {
namespace {

struct CalibrateOptions {
  std::string scene;
  std::vector<std::string> overrides;
  std::vector<std::string> data;
  std::optional<double> frequency_Hz, stroke_mm, voltage_V;
  std::vector<std::string> free;
  std::string output;
  bool force = false;
  int points = 8;
  std::string picture;
  bool json = false;
  std::vector<std::string> petsc;
};

bool read_all(std::string_view text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return !text.empty() && error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

/// "geometry.rim_gap_scale=0.8:1.2"
FreeKey parse_free_key(const std::string& text) {
  const auto equals = text.find('=');
  const auto colon = text.find(':', equals == std::string::npos ? 0 : equals);
  FreeKey key;
  if (equals == std::string::npos || equals == 0 || colon == std::string::npos ||
      !read_all(std::string_view(text).substr(equals + 1, colon - equals - 1), key.low) ||
      !read_all(std::string_view(text).substr(colon + 1), key.high)) {
    throw InputError("a free key cannot be read", '"' + text + '"',
                     "section.key=low:high, for instance operating_point.stroke_scale=0.95:1.05", "--free");
  }
  key.key = text.substr(0, equals);
  return key;
}

/// Frequency or stroke of a measured curve: as given, else as the file states it.
double setting(const std::optional<double>& given, const std::optional<double>& stated, const char* key,
               const char* option, const std::string& file) {
  if (!given && !stated) {
    throw InputError("the data do not state how the pump was driven", std::string("no ") + key,
                     std::string("a line # ") + key + " = ... before the columns, or " + option +
                         " where there is one file",
                     file);
  }
  return given ? *given : *stated;
}

std::vector<TargetCurve> make_targets(const CalibrateOptions& options, const Scene& scene,
                                      std::span<const MeasuredCurve> measured) {
  const bool by_voltage = scene.operating_point.drive == Drive::voltage;
  if (by_voltage && options.stroke_mm) {
    throw InputError("a voltage drives the scene", "--stroke " + plain_number(*options.stroke_mm),
                     "--voltage, or operating_point.drive = \"stroke\"", "--stroke");
  }
  if (!by_voltage && options.voltage_V) {
    throw InputError("a stroke drives the scene", "--voltage " + plain_number(*options.voltage_V),
                     "--stroke, or operating_point.drive = \"voltage\"", "--voltage");
  }
  if (options.data.size() > 1 && (options.frequency_Hz || options.stroke_mm || options.voltage_V)) {
    throw InputError("one frequency, stroke or voltage cannot serve several data files",
                     std::to_string(options.data.size()) + " files with --frequency, --stroke or --voltage",
                     "one file, or files that state both themselves", "--data");
  }
  std::vector<TargetCurve> targets;
  for (std::size_t c = 0; c < measured.size(); ++c) {
    const MeasuredCurve& curve = measured[c];
    TargetCurve target;
    target.name = options.data[c];
    target.frequency_Hz =
        setting(options.frequency_Hz, curve.frequency_Hz, "frequency_Hz", "--frequency", target.name);
    OperatingPoint asked = scene.operating_point;
    asked.frequency = target.frequency_Hz;
    if (by_voltage) {
      target.voltage_V = setting(options.voltage_V, curve.voltage_V, "voltage_V", "--voltage", target.name);
      asked.voltage = target.voltage_V;
    } else {
      target.stroke_mm = setting(options.stroke_mm, curve.stroke_mm, "stroke_mm", "--stroke", target.name);
      asked.stroke = units::length_from_mm(target.stroke_mm);
    }
    warn_of_other_point(curve, target.name, "the command line", asked);
    target.head_mmHg = even_heads(curve.head_mmHg.front(), curve.head_mmHg.back(), options.points);
    for (const double head : target.head_mmHg) {
      target.flow_l_per_min.push_back(curve.fit(head));
    }
    target.scatter_l_per_min = curve.fit.scatter_l_per_min;
    targets.push_back(std::move(target));
  }
  return targets;
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

void run_calibration(const CalibrateOptions& options, MPI_Comm comm) {
  // 1. Everything that may be wrong with the input comes before the first result.
  check_output(options);
  if (!options.picture.empty()) {
    check_picture_name(options.picture);
  }
  const Scene scene = read_scene(options.scene, options.overrides);
  require_pump(scene, "undula calibrate");
  std::vector<FreeKey> keys;
  for (const std::string& text : options.free) {
    keys.push_back(parse_free_key(text));
  }
  check_free_keys(scene, keys);
  std::vector<MeasuredCurve> measured;
  for (const std::string& file : options.data) {
    measured.push_back(read_measured_curve(file));
  }
  const std::vector<TargetCurve> targets = make_targets(options, scene, measured);

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
    const FlowsOfValues flows = flows_of_scene(scene, keys, targets, comm, [&](const std::string& reason) {
      if (!options.json) {
        spdlog::warn("refused a set of values: {}", reason);
      }
    });
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

  // 3. The scene and the numbers; the picture beside them.
  on_root(comm, [&] {
    Scene calibrated = with_values(scene, keys, calibration.optimum);
    calibrated.name = std::filesystem::path(options.output).stem().string();
    for (const FreeKey& key : keys) {
      narrow_tolerance(calibrated, key.key);
    }
    const CalibrationReport report = {calibrated, keys, targets, calibration};
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
  command
      ->add_option("--data", options->data,
                   "measured points (CSV: head_mmHg,flow_l_per_min), may be repeated")
      ->required()
      ->allow_extra_args(false);
  command
      ->add_option("--free", options->free,
                   "a key to fit and its range in the key's unit, section.key=low:high, may be repeated")
      ->type_name("KEY=LOW:HIGH")
      ->required()
      ->allow_extra_args(false);
  command->add_option("--output", options->output, "the calibrated scene (.toml)")->required();
  command->add_flag("--force", options->force, "replace an existing output");
  command->add_option("--points", options->points, "heads per curve, spread over the measured range")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--frequency", options->frequency_Hz, "frequency of the data, Hz, in place of the file's")
      ->check(CLI::PositiveNumber);
  command->add_option("--stroke", options->stroke_mm, "stroke of the data, mm, in place of the file's")
      ->check(CLI::PositiveNumber);
  command->add_option("--voltage", options->voltage_V, "voltage of the data, V, in place of the file's")
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
