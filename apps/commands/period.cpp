// undula period model.h5: what the pump does over a period at an operating point, by an emulator of runs that
// recorded it: the course of the membrane and of the outflow.
//   undula period data/models/wave_pump_mapped_voltage.h5 --frequency 120 --voltage 40 --head 50 --plot p.png
//   undula period model.h5 --frequency 120 --voltage 40 --head 50 --json
#include <spdlog/spdlog.h>

#include <cmath>
#include <iostream>
#include <memory>

#include "apps/commands/commands.hpp"
#include "apps/input/level_source.hpp"
#include "apps/mpi_session.hpp"
#include "apps/output/gnuplot.hpp"
#include "apps/output/period_report.hpp"
#include "fom/levels/emulated_level.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"

namespace undula::apps {
namespace {

struct PeriodOptions {
  std::string file;
  std::vector<std::string> overrides;
  double frequency_Hz = 0;
  std::optional<double> stroke_mm, voltage_V;
  double head_mmHg = 0;
  std::string picture;
  bool json = false;
};

void show_period(const PeriodOptions& options) {
  if (!options.picture.empty()) {
    check_picture_name(options.picture);
  }
  if (is_scene(options.file)) {
    throw InputError("a scene's period is computed, not looked up", options.file,
                     "an emulator (.h5) that undula train made; undula solve for the scene", "undula period");
  }
  if (!rom::holds_emulator(options.file)) {
    throw InputError("this model keeps no course over a period", options.file,
                     "an emulator (.h5) of a scene with coupling = \"mapped\"", "undula period");
  }
  auto source = read_level_source(options.file, options.overrides, options.frequency_Hz, options.stroke_mm,
                                  options.voltage_V);
  source.scene.operating_point.head = units::pressure_from_mmHg(options.head_mmHg);
  const rom::Emulator& emulator = *source.emulator;
  if (emulator.responses.empty()) {
    throw InputError("the runs of this emulator recorded no fields", options.file,
                     "an emulator of a scene with coupling = \"mapped\", trained by this version",
                     "undula period");
  }
  EmulatedLevel level(emulator);
  for (const std::string& remark : level.remarks(source.scene, std::span(&options.head_mmHg, 1))) {
    spdlog::warn("{}", remark);
  }
  const PeriodReport report = period_report(emulator, emulator_point(emulator, source.scene));
  std::cout << (options.json ? period_json(report, source.scene.operating_point) : period_table(report));
  if (!options.picture.empty()) {
    plot_period(options.picture, report, source.scene.operating_point);
  }
}

} // namespace

void add_period_command(CLI::App& app) {
  auto options = std::make_shared<PeriodOptions>();
  CLI::App* command = app.add_subcommand(
      "period", "Course of membrane and outflow over a period, by an emulator (docs/emulator.md)");
  command->add_option("model", options->file, "emulator (.h5)")->required();
  command->add_option("--frequency", options->frequency_Hz, "frequency, Hz")
      ->required()
      ->check(CLI::PositiveNumber);
  command->add_option("--stroke", options->stroke_mm, "stroke, mm, of an emulator that a stroke drives");
  command->add_option("--voltage", options->voltage_V, "voltage, V, of one that a voltage drives");
  command->add_option("--head", options->head_mmHg, "head, mmHg")->required();
  command
      ->add_option("--set", options->overrides, "a further input of the emulator: KEY=VALUE, may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_option("--plot", options->picture, "picture to draw (.png)");
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options] {
    if (is_first_process()) {
      show_period(*options);
    }
  });
}

} // namespace undula::apps
