// undula validate model.h5 --data measured.csv: the benchmark's algorithm. Read the measured curve, extract
// points, run the model at their heads, average over the last period, plot, 2-norm of the errors.
//   undula validate data/models/wave_pump_fixed.h5 --frequency 120 --stroke 0.53 --head 50,55,60
//     --data data/measured/corwave_120hz_0.53mm.csv --plot validation.png
#include <spdlog/spdlog.h>

#include <array>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/commands.hpp"
#include "apps/gnuplot.hpp"
#include "apps/head_list.hpp"
#include "apps/plots.hpp"
#include "apps/progress.hpp"
#include "apps/text_table.hpp"
#include "apps/validation.hpp"
#include "hq_curve.hpp"
#include "model.hpp"

namespace undula {
namespace {

struct ValidateOptions {
  std::string model;
  std::string data;
  double frequency_Hz = 0;
  double stroke_mm = 0;
  std::string heads;
  int points = 3;
  std::string picture;
  bool json = false;
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

void validate_model(const ValidateOptions& options) {
  // 1. Read the measured curve and choose the heads.
  if (!options.picture.empty()) {
    check_picture_name(options.picture);
  }
  const MeasuredCurve curve = read_measured_curve(options.data);
  const std::vector<double> heads =
      options.heads.empty() ? even_heads(curve.head_mmHg.front(), curve.head_mmHg.back(), options.points)
                            : parse_heads(options.heads);

  // 2. The model.
  const rom::Model model = rom::load_model(options.model);
  for (const std::string& line :
       rom::outside_training_box(model.box, options.frequency_Hz, options.stroke_mm, heads)) {
    spdlog::warn("{}", line);
  }

  // 3. Run it at those heads; every flow is a mean over the last period.
  const FlowAtHead flow_at = flow_of_model(model, options.frequency_Hz, options.stroke_mm);
  Validation validation;
  {
    Progress progress("validate", static_cast<long>(heads.size()));
    long done = 0;
    validation = validate(curve, heads, [&](double head) {
      const double flow = flow_at(head);
      progress.update(++done);
      return flow;
    });
  }

  // 4. Compare.
  std::cout << (options.json ? json_text(validation, curve.fit) : table_text(validation));
  if (!options.picture.empty()) {
    plot(options.picture, curve, validation,
         shortest(options.frequency_Hz) + " Hz, stroke " + shortest(options.stroke_mm) + " mm");
  }
}

} // namespace

void add_validate_command(CLI::App& app) {
  auto options = std::make_shared<ValidateOptions>();
  CLI::App* command = app.add_subcommand("validate", "Compare a model with a measured head-flow curve");
  command->add_option("model", options->model, "model file (HDF5) made by undula train")->required();
  command->add_option("--data", options->data, "measured points (CSV: head_mmHg,flow_l_per_min)")->required();
  command->add_option("--frequency", options->frequency_Hz, "frequency of the actuator, Hz")->required();
  command->add_option("--stroke", options->stroke_mm, "amplitude of the actuator, mm")->required();
  CLI::Option* heads =
      command->add_option("--head", options->heads, "heads in mmHg, low:high:step or a list with commas");
  command->add_option("--points", options->points, "number of heads, spread over the measured range")
      ->check(CLI::Range(1, 1000))
      ->excludes(heads)
      ->capture_default_str();
  command->add_option("--plot", options->picture, "picture to draw (.png)");
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options] { validate_model(*options); });
}

} // namespace undula
