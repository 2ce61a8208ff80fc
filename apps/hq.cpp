// undula hq model.h5: the head-flow curve of a reduced model.
//   undula hq data/models/wave_pump_fixed.h5 --frequency 120 --stroke 0.53 --head 40:62:2
//   undula hq model.h5 --frequency 120 --stroke 0.53 --head 50,55,60 --json
//   undula hq model.h5 --frequency 120 --stroke 0.53 --data data/measured/corwave_120hz_0.53mm.csv --plot
//   hq.png
#include <spdlog/spdlog.h>

#include <iostream>
#include <memory>

#include "apps/commands.hpp"
#include "apps/gnuplot.hpp"
#include "apps/head_list.hpp"
#include "apps/hq_report.hpp"

namespace undula {
namespace {

struct HqCommandOptions {
  std::string model;
  double frequency_Hz = 0;
  double stroke_mm = 0;
  std::string heads;
  std::string data;
  std::string picture;
  bool json = false;
};

void hq(const HqCommandOptions& options) {
  // 1. Everything that may be wrong with the input comes before the first result.
  if (!options.picture.empty()) {
    check_picture_name(options.picture);
  }
  const rom::Model model = rom::load_model(options.model);
  constexpr int default_points = 12;
  const std::vector<double> heads =
      options.heads.empty() ? even_heads(model.box.head_low_mmHg, model.box.head_high_mmHg, default_points)
                            : parse_heads(options.heads);
  std::optional<MeasuredCurve> measured;
  if (!options.data.empty()) {
    measured = read_measured_curve(options.data);
  }

  // 2. The curve, and how far it can be trusted.
  const auto points = rom::hq_curve(model, options.frequency_Hz, options.stroke_mm, heads);
  for (const std::string& line :
       rom::outside_training_box(model.box, options.frequency_Hz, options.stroke_mm, heads)) {
    spdlog::warn("{}", line);
  }
  for (const rom::HqPoint& point : points) {
    if (!point.converged) {
      spdlog::warn("no periodic state at {} mmHg: the flow is the mean of the last period", point.head_mmHg);
    }
  }

  // 3. Numbers to stdout, picture beside them.
  const HqReport report = {options.model, options.frequency_Hz, options.stroke_mm, points,
                           measured ? &*measured : nullptr};
  std::cout << (options.json ? hq_json(report) : hq_table(report));
  if (!options.picture.empty()) {
    plot_hq_report(options.picture, report, model);
  }
}

} // namespace

void add_hq_command(CLI::App& app) {
  auto options = std::make_shared<HqCommandOptions>();
  CLI::App* command = app.add_subcommand("hq", "Head-flow curve of a reduced model: table, JSON, plot");
  command->add_option("model", options->model, "model file (HDF5) made by undula train")->required();
  command->add_option("--frequency", options->frequency_Hz, "frequency of the actuator, Hz")->required();
  command->add_option("--stroke", options->stroke_mm, "amplitude of the actuator, mm")->required();
  command->add_option(
      "--head", options->heads,
      "heads in mmHg, low:high:step or a list with commas; default: 12 over the training box");
  command->add_option("--data", options->data, "measured points (CSV: head_mmHg,flow_l_per_min)");
  command->add_option("--plot", options->picture, "picture to draw (.png)");
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options] { hq(*options); });
}

} // namespace undula
