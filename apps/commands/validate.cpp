// undula validate model.h5|scene.toml --data measured.csv: the benchmark's algorithm. Read the measured
// curve, extract points, run the model at their heads, average over the last period, plot, 2-norm of the
// errors.
//   undula validate data/models/wave_pump_fixed.h5 --frequency 120 --stroke 0.53 --head 50,55,60
//     --data data/measured/corwave_120hz_0.53mm.csv --plot validation.png
//   undula validate data/scenes/wave_pump_fixed.toml --points 3 --data data/measured/corwave_120hz_0.53mm.csv
#include <spdlog/spdlog.h>

#include <array>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/apps.hpp"
#include "apps/commands/commands.hpp"
#include "apps/input/head_list.hpp"
#include "apps/input/scene_flow.hpp"
#include "apps/input/validation.hpp"
#include "apps/mpi_session.hpp"
#include "apps/output/gnuplot.hpp"
#include "apps/output/plots.hpp"
#include "apps/output/progress.hpp"
#include "apps/output/text_table.hpp"
#include "fom/output/root_rank.hpp"
#include "rom/base/error.hpp"
#include "rom/base/units.hpp"
#include "rom/curve/hq_curve.hpp"
#include "rom/fixed_domain/model.hpp"

namespace undula::apps {
namespace {

struct ValidateOptions {
  std::string model;
  std::vector<std::string> overrides;
  std::string data;
  std::optional<double> frequency_Hz;
  std::optional<double> stroke_mm;
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

/// The reduced model as a function of the head; `frequency` and `stroke` stay as asked.
FlowAtHead flow_of_model(const rom::Model& model, double frequency_Hz, double stroke_mm) {
  return [&model, frequency_Hz, stroke_mm](double head_mmHg) {
    rom::HqOptions options;
    options.estimate_errors = false;
    return rom::hq_curve(model, frequency_Hz, stroke_mm, std::span(&head_mmHg, 1), options)
        .front()
        .flow_l_per_min;
  };
}

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
  plot_hq_curve(picture, title,
                {"quadratic fit of the data", curve.head_mmHg, fit_flow, scatter, "scatter of the data"},
                sets);
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

void report(const ValidateOptions& options, const MeasuredCurve& curve, const Validation& validation,
            double frequency_Hz, double stroke_mm) {
  std::cout << (options.json ? json_text(validation, curve.fit) : table_text(validation));
  if (!options.picture.empty()) {
    plot(options.picture, curve, validation,
         shortest(frequency_Hz) + " Hz, stroke " + shortest(stroke_mm) + " mm");
  }
}

void validate_model(const ValidateOptions& options) {
  // 1. Read the measured curve and choose the heads.
  const Comparison comparison = read_comparison(options);
  if (!options.overrides.empty() || !options.petsc.empty()) {
    throw InputError("options of scenes do not go with a reduced model", options.model,
                     "a scene (.toml) with --set and options for PETSc", "the command line");
  }
  if (!options.frequency_Hz || !options.stroke_mm) {
    throw CLI::RequiredError(options.frequency_Hz ? "--stroke" : "--frequency");
  }

  warn_of_other_point(comparison.curve, options.data, "the model", *options.frequency_Hz, *options.stroke_mm);

  // 2. The model.
  const rom::Model model = rom::load_model(options.model);
  for (const std::string& line :
       rom::outside_training_box(model.box, *options.frequency_Hz, *options.stroke_mm, comparison.heads)) {
    spdlog::warn("{}", line);
  }

  // 3. Run it at those heads; every flow is a mean over the last period.
  const FlowAtHead flow_at = flow_of_model(model, *options.frequency_Hz, *options.stroke_mm);
  Validation validation;
  {
    Progress progress("validate", static_cast<long>(comparison.heads.size()));
    long done = 0;
    validation = validate(comparison.curve, comparison.heads, [&](double head) {
      const double flow = flow_at(head);
      progress.update(++done);
      return flow;
    });
  }

  // 4. Compare.
  report(options, comparison.curve, validation, *options.frequency_Hz, *options.stroke_mm);
}

void validate_scene(const ValidateOptions& options, MPI_Comm comm) {
  // 1. Read the scene and the measured curve; choose the heads.
  const Comparison comparison = read_comparison(options);
  const Scene scene =
      read_scene_at(options.model, options.overrides, options.frequency_Hz, options.stroke_mm);

  warn_of_other_point(comparison.curve, options.data, "the scene", scene.operating_point.frequency,
                      units::length_to_mm(scene.operating_point.stroke));

  // 2. Meshes and operators, or coefficients, shared by all heads.
  PhaseTimer timer;
  PreparedLevel level = prepare_level(scene, comm, timer);

  // 3. Run it at those heads; every flow is a mean over the last period.
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  Validation validation;
  {
    const long steps = static_cast<long>(scene.time.periods) * scene.time.steps_per_period;
    std::optional<Progress> progress;
    if (rank == 0) {
      progress.emplace("validate", steps * static_cast<long>(comparison.heads.size()));
    }
    long done = 0;
    const std::function<void()> on_step = [&] {
      ++done;
      if (progress) {
        progress->update(done);
      }
    };
    validation = validate(comparison.curve, comparison.heads, flow_of_scene(level, scene, on_step));
  }

  // 4. Compare.
  on_root(comm, [&] {
    report(options, comparison.curve, validation, scene.operating_point.frequency,
           units::length_to_mm(scene.operating_point.stroke));
  });
}

} // namespace

void add_validate_command(CLI::App& app) {
  auto options = std::make_shared<ValidateOptions>();
  CLI::App* command = app.add_subcommand("validate", "Compare a model with a measured head-flow curve");
  command
      ->add_option("model", options->model,
                   "model file (HDF5) made by undula train, or a scene (.toml) for the full-order model")
      ->required();
  command->add_option("--data", options->data, "measured points (CSV: head_mmHg,flow_l_per_min)")->required();
  command->add_option("--frequency", options->frequency_Hz,
                      "frequency of the actuator, Hz; of a scene: its own");
  command->add_option("--stroke", options->stroke_mm, "amplitude of the actuator, mm; of a scene: its own");
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
    if (is_scene_file(options->model)) {
      run_parallel(options->petsc, [&](MPI_Comm comm) { validate_scene(*options, comm); });
    } else if (is_first_process()) {
      validate_model(*options);
    }
  });
}

} // namespace undula::apps
