// undula report FILE...: speed against error over the levels of the hierarchy. A file is a scene (computed
// now), a reduced model (computed now) or recorded runs (what `undula hq SCENE --json` printed).
//   undula report data/scenes/wave_pump_thin_gap.toml data/models/wave_pump_fixed.h5
//     --data data/measured/corwave_120hz_0.53mm.csv --frequency 120 --stroke 0.53 --plot report.png
//   undula report data/scenes/wave_pump_thin_gap.toml --vary thin_gap.cells=32,64,128 --data ...
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
#include "apps/input/measured_curve.hpp"
#include "apps/input/recorded_curve.hpp"
#include "apps/mpi_session.hpp"
#include "apps/output/curve_warnings.hpp"
#include "apps/output/gnuplot.hpp"
#include "apps/output/level_report.hpp"
#include "apps/output/text_table.hpp"
#include "fom/output/root_rank.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::apps {
namespace {

struct ReportOptions {
  std::vector<std::string> files;
  std::string data;
  double frequency_Hz = 0, stroke_mm = 0;
  int points = 5;
  std::vector<std::string> variations;
  std::string picture;
  bool json = false;
  std::vector<std::string> petsc;
};

/// A key with the values it takes in turn, coarse to fine.
struct Variation {
  std::string key;
  std::vector<std::string> values;
};

Variation parse_variation(const std::string& text) {
  Variation variation;
  const auto equals = text.find('=');
  if (equals != std::string::npos) {
    variation.key = text.substr(0, equals);
    for (std::size_t begin = equals + 1; begin <= text.size();) {
      const std::size_t end = std::min(text.find(',', begin), text.size());
      variation.values.push_back(text.substr(begin, end - begin));
      begin = end + 1;
    }
  }
  if (variation.values.size() < 2) {
    throw InputError("a variation cannot be read", text, "section.key=coarse,...,finest", "--vary");
  }
  return variation;
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// A scene or a reduced model, computed now.
LevelResult compute(const ReportOptions& options, const std::string& file,
                    const std::vector<std::string>& overrides, std::span<const double> heads, MPI_Comm comm) {
  const LevelSource source = read_level_source(file, overrides, options.frequency_Hz, options.stroke_mm);
  const auto begin = std::chrono::steady_clock::now();
  PhaseTimer timer;
  const auto level = prepare(source, comm, timer);
  const std::vector<CurvePoint> points = level->curve(source.scene, heads);
  LevelResult result;
  result.level = level->name();
  result.source = file;
  for (const std::string& text : overrides) {
    result.source += ", " + text;
  }
  result.unknowns = level->unknowns();
  for (const CurvePoint& point : points) {
    result.flow.push_back(point.flow_l_per_min);
  }
  result.seconds_per_point = seconds_since(begin) / static_cast<double>(heads.size());
  on_root(comm, [&] { warn_of_curve(*level, source.scene, points); });
  return result;
}

/// Flows at `heads` by linear interpolation between the recorded ones; NaN outside of them.
LevelResult read_runs(const ReportOptions& options, const std::string& file, std::span<const double> heads) {
  const RecordedCurve curve = read_recorded_curve(file);
  if (!same_setting(curve.frequency_Hz, options.frequency_Hz) ||
      !same_setting(curve.stroke_mm, options.stroke_mm)) {
    throw InputError("recorded runs belong to another operating point",
                     plain_number(curve.frequency_Hz) + " Hz, " + plain_number(curve.stroke_mm) + " mm",
                     plain_number(options.frequency_Hz) + " Hz, " + plain_number(options.stroke_mm) + " mm",
                     file);
  }
  LevelResult result;
  result.level = "full order, recorded";
  result.source = file;
  result.unknowns = curve.unknowns;
  result.seconds_per_point = curve.seconds_per_point;
  for (const double head : heads) {
    double flow = std::nan("");
    for (std::size_t i = 1; i < curve.head_mmHg.size(); ++i) {
      const double low = curve.head_mmHg[i - 1], high = curve.head_mmHg[i];
      if (head >= low && head <= high && high > low) {
        const double s = (head - low) / (high - low);
        flow = (1 - s) * curve.flow_l_per_min[i - 1] + s * curve.flow_l_per_min[i];
      }
    }
    result.flow.push_back(flow);
  }
  return result;
}

void report(const ReportOptions& options, MPI_Comm comm) {
  // 1. Everything that may be wrong with the input comes before the first result.
  if (!options.picture.empty()) {
    check_picture_name(options.picture);
  }
  const MeasuredCurve measured = read_measured_curve(options.data);
  OperatingPoint asked;
  asked.frequency = options.frequency_Hz;
  asked.stroke = units::length_from_mm(options.stroke_mm);
  warn_of_other_point(measured, options.data, "the report", asked);
  std::vector<Variation> variations;
  for (const std::string& text : options.variations) {
    variations.push_back(parse_variation(text));
  }
  LevelReport table;
  table.data_file = options.data;
  table.frequency_Hz = options.frequency_Hz;
  table.stroke_mm = options.stroke_mm;
  table.head_mmHg = even_heads(measured.head_mmHg.front(), measured.head_mmHg.back(), options.points);
  table.scatter_l_per_min = measured.fit.scatter_l_per_min;
  for (const double head : table.head_mmHg) {
    table.measured.push_back(measured.fit(head));
  }

  // 2. Every level, as it is and varied.
  int model = -1, runs = -1;
  for (const std::string& file : options.files) {
    if (is_scene(file)) {
      table.results.push_back(compute(options, file, {}, table.head_mmHg, comm));
      for (const Variation& variation : variations) {
        const int finest = static_cast<int>(table.results.size() + variation.values.size()) - 1;
        for (const std::string& value : variation.values) {
          table.results.push_back(
              compute(options, file, {variation.key + "=" + value}, table.head_mmHg, comm));
          if (static_cast<int>(table.results.size()) - 1 != finest) {
            table.results.back().reference = finest;
          }
        }
      }
    } else if (std::filesystem::path(file).extension() == ".json") {
      runs = static_cast<int>(table.results.size());
      table.results.push_back(read_runs(options, file, table.head_mmHg));
    } else {
      model = static_cast<int>(table.results.size());
      table.results.push_back(compute(options, file, {}, table.head_mmHg, comm));
    }
  }
  if (model >= 0 && runs >= 0) { // recorded runs beside one reduced model are those it should repeat
    table.results[static_cast<std::size_t>(model)].reference = runs;
  }

  // 3. Numbers to stdout, picture beside them.
  on_root(comm, [&] {
    std::cout << (options.json ? level_report_json(table) : level_report_table(table));
    if (!options.picture.empty()) {
      plot_level_report(options.picture, table);
    }
  });
}

} // namespace

void add_report_command(CLI::App& app) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* command = app.add_subcommand("report", "Speed against error of several levels and settings");
  command
      ->add_option(
          "files", options->files,
          "scenes (.toml), reduced models (.h5), recorded runs (.json, what `hq SCENE --json` prints)")
      ->required();
  command->add_option("--data", options->data, "measured points (CSV: head_mmHg,flow_l_per_min)")->required();
  command->add_option("--frequency", options->frequency_Hz, "frequency of the data, Hz")
      ->required()
      ->check(CLI::PositiveNumber);
  command->add_option("--stroke", options->stroke_mm, "stroke of the data, mm")
      ->required()
      ->check(CLI::PositiveNumber);
  command->add_option("--points", options->points, "number of heads, spread over the measured range")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  command
      ->add_option("--vary", options->variations,
                   "compute scenes also with these values of a key, coarse to finest; may be repeated")
      ->type_name("KEY=V1,V2,...")
      ->allow_extra_args(false);
  command->add_option("--plot", options->picture, "picture to draw (.png)");
  command->add_flag("--json", options->json, "print JSON");
  command->add_option("--petsc", options->petsc, "options for PETSc")->allow_extra_args(false);
  command->callback([options] {
    const bool scenes = std::ranges::any_of(options->files, is_scene);
    (scenes ? run_parallel : run_alone)(options->petsc, [&](MPI_Comm comm) { report(*options, comm); });
  });
}

} // namespace undula::apps
