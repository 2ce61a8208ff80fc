// undula validate model.h5|scene.toml --data measured.csv: the benchmark's algorithm. Read the measured
// curve, extract points, find the periodic state at their heads, average over its last period, plot, 2-norm
// of the errors.
//   undula validate data/models/wave_pump_fixed.h5 --frequency 120 --stroke 0.53 --head 50,55,60
//     --data data/measured/corwave_120hz_0.53mm.csv --plot validation.png
//   undula validate data/scenes/wave_pump_fixed.toml --points 3 --data data/measured/corwave_120hz_0.53mm.csv
#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/apps.hpp"
#include "apps/commands/commands.hpp"
#include "apps/input/head_list.hpp"
#include "apps/input/level_source.hpp"
#include "apps/input/validation.hpp"
#include "apps/mpi_session.hpp"
#include "apps/output/curve_progress.hpp"
#include "apps/output/curve_warnings.hpp"
#include "apps/output/gnuplot.hpp"
#include "apps/output/plots.hpp"
#include "apps/output/text_table.hpp"
#include "fom/output/root_rank.hpp"
#include "fom/scene/operating_point.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::apps {
namespace {

struct ValidateOptions {
  std::string file;
  std::vector<std::string> overrides;
  std::string data;
  std::optional<double> frequency_Hz;
  std::optional<double> stroke_mm;
  std::optional<double> voltage_V;
  std::string heads;
  int points = 3;
  std::string picture;
  bool json = false;
  std::vector<std::string> petsc;
};

/// What is compared, and at which heads.
struct Comparison {
  MeasuredCurve curve;
  std::vector<double> heads;
};

std::string table_text(const Validation& validation) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& [measured, computed] : validation.points) {
    rows.push_back({decimals(measured.head_mmHg, 2), decimals(measured.fit_l_per_min, 3),
                    decimals(measured.nearest_l_per_min, 3), decimals(computed, 3),
                    decimals(computed - measured.fit_l_per_min, 3)});
  }
  return text_table({"head (mmHg)", "measured, fit (l/min)", "nearest sample (l/min)", "computed (l/min)",
                     "computed - fit (l/min)"},
                    rows) +
         "2-norm of the error: " + decimals(validation.norm_to_fit_l_per_min, 3) +
         " l/min against the fit, " + decimals(validation.norm_to_nearest_l_per_min, 3) +
         " l/min against the nearest samples\n";
}

std::string json_text(const Validation& validation, const QuadraticFit& fit) {
  nlohmann::ordered_json result = {{"points", nlohmann::ordered_json::array()}};
  for (const auto& [measured, computed] : validation.points) {
    result["points"].push_back({{"head_mmHg", measured.head_mmHg},
                                {"fit_l_per_min", measured.fit_l_per_min},
                                {"nearest_head_mmHg", measured.nearest_head_mmHg},
                                {"nearest_l_per_min", measured.nearest_l_per_min},
                                {"computed_l_per_min", computed}});
  }
  result["norm_to_fit_l_per_min"] = validation.norm_to_fit_l_per_min;
  result["norm_to_nearest_l_per_min"] = validation.norm_to_nearest_l_per_min;
  result["fit_scatter_l_per_min"] = fit.scatter_l_per_min;
  return result.dump(2) + "\n";
}

void plot(const std::string& picture, const MeasuredCurve& curve, const Validation& validation,
          const std::string& title) {
  std::vector<double> heads, computed;
  for (const ValidatedPoint& point : validation.points) {
    heads.push_back(point.measured.head_mmHg);
    computed.push_back(point.computed_l_per_min);
  }
  std::vector<double> fit_flow;
  for (const double head : curve.head_mmHg) {
    fit_flow.push_back(curve.fit(head));
  }
  const std::vector<double> scatter(fit_flow.size(), curve.fit.scatter_l_per_min);
  const std::array<HqPoints, 2> sets = {
      {{"computed", heads, computed}, {"measured", curve.head_mmHg, curve.flow_l_per_min}}};
  const HqLine fit = {"quadratic fit of the data", curve.head_mmHg, fit_flow, scatter, "scatter of the data"};
  plot_hq_curves(picture, title, std::span(&fit, 1), sets);
}

Comparison read_comparison(const ValidateOptions& options) {
  if (!options.picture.empty()) {
    check_picture_name(options.picture);
  }
  Comparison comparison{read_measured_curve(options.data), {}};
  const auto& measured = comparison.curve.head_mmHg;
  comparison.heads = options.heads.empty() ? even_heads(measured.front(), measured.back(), options.points)
                                           : parse_heads(options.heads);
  extract_points(comparison.curve, comparison.heads); // refuses heads outside the data
  return comparison;
}

void run(const ValidateOptions& options, MPI_Comm comm) {
  // 1. Read the measured curve and the scene or model; choose the heads.
  const Comparison comparison = read_comparison(options);
  const LevelSource source = read_level_source(options.file, options.overrides, options.frequency_Hz,
                                               options.stroke_mm, options.voltage_V);
  const Scene& scene = source.scene;
  warn_of_other_point(comparison.curve, options.data, source.is_model() ? "the model" : "the scene",
                      scene.operating_point);

  // 2. Meshes and operators, coefficients, or modes, shared by all heads.
  PhaseTimer timer;
  const auto level = prepare(source, comm, timer);

  // 3. The periodic state at those heads; every flow is a mean over its last periods.
  const std::vector<CurvePoint> points =
      curve_with_progress("validate", *level, scene, comparison.heads, comm);

  // 4. Compare.
  on_root(comm, [&] {
    warn_of_curve(*level, scene, points);
    std::vector<double> flows;
    for (const CurvePoint& point : points) {
      if (!std::isfinite(point.flow_l_per_min)) {
        throw NumericsError("a head has no flow to compare: " + point.reason,
                            plain_number(point.head_mmHg) + " mmHg",
                            "other heads with --head, or a smaller step");
      }
      flows.push_back(point.flow_l_per_min);
    }
    const Validation validation = validate(comparison.curve, comparison.heads, flows);
    std::cout << (options.json ? json_text(validation, comparison.curve.fit) : table_text(validation));
    if (!options.picture.empty()) {
      plot(options.picture, comparison.curve, validation,
           level->name() + ": " + setting_text(scene.operating_point));
    }
  });
}

} // namespace

void add_validate_command(CLI::App& app) {
  auto options = std::make_shared<ValidateOptions>();
  CLI::App* command = app.add_subcommand("validate", "Compare a model with a measured head-flow curve");
  command->add_option("model", options->file, "model file (HDF5) made by undula train, or a scene (.toml)")
      ->required();
  command->add_option("--data", options->data, "measured points (CSV: head_mmHg,flow_l_per_min)")->required();
  command->add_option("--frequency", options->frequency_Hz,
                      "frequency of the actuator, Hz; of a scene: its own");
  CLI::Option* stroke = command->add_option("--stroke", options->stroke_mm,
                                            "amplitude of the actuator, mm; of a scene: its own");
  command
      ->add_option("--voltage", options->voltage_V,
                   "of a scene: amplitude of the voltage that drives its actuator, V")
      ->excludes(stroke);
  CLI::Option* heads =
      command->add_option("--head", options->heads, "heads in mmHg, low:high:step or a list with commas");
  command->add_option("--points", options->points, "number of heads, spread over the measured range")
      ->check(CLI::Range(1, 1000))
      ->excludes(heads)
      ->capture_default_str();
  command->add_option("--plot", options->picture, "picture to draw (.png)");
  command->add_flag("--json", options->json, "print JSON");
  command
      ->add_option("--set", options->overrides,
                   "of a scene: override a key, section.key=value, may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_option("petsc", options->petsc, "of a scene: options for PETSc, after --");
  command->callback([options] {
    (is_scene(options->file) ? run_parallel : run_alone)(options->petsc,
                                                         [&](MPI_Comm comm) { run(*options, comm); });
  });
}

} // namespace undula::apps
