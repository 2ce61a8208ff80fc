// undula hq model.h5|scene.toml: the head-flow curve of a reduced model, or of the level that a scene states.
//   undula hq data/models/wave_pump_fixed.h5 --frequency 120 --stroke 0.53 --head 40:62:2
//   undula hq model.h5 --frequency 120 --stroke 0.53 --head 50,55,60 --json
//   undula hq model.h5 --frequency 120 --stroke 0.53 --data data/measured/corwave_120hz_0.53mm.csv --plot
//   hq.png
//   undula hq data/scenes/wave_pump_thin_gap.toml --data data/measured/corwave_120hz_0.53mm.csv --plot hq.png
//   undula hq data/scenes/wave_pump_thin_gap.toml --band --plot hq.png
//   undula hq data/scenes/wave_pump_fixed.toml --head 0,20,40,60 --set mesh.gap_elements=3
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>

#include "apps/apps.hpp"
#include "apps/commands/commands.hpp"
#include "apps/commands/curve_bands.hpp"
#include "apps/input/head_list.hpp"
#include "apps/input/level_source.hpp"
#include "apps/input/target_curves.hpp"
#include "apps/input/tiers.hpp"
#include "apps/mpi_session.hpp"
#include "apps/output/curve_progress.hpp"
#include "apps/output/curve_report.hpp"
#include "apps/output/curve_warnings.hpp"
#include "apps/output/gnuplot.hpp"
#include "apps/output/text_table.hpp"
#include "fom/levels/emulated_level.hpp"
#include "fom/levels/moving_reduced_level.hpp"
#include "fom/output/root_rank.hpp"
#include "fom/scene/operating_point.hpp"
#include "fom/scene/scene_value.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"
#include "rom/base/units.hpp"
#include "training/calibration/uncertainty.hpp"

namespace undula::apps {
namespace {

constexpr int default_points = 12, heads_per_given_curve = 8;

struct HqCommandOptions {
  std::string file;
  std::optional<double> frequency_Hz;
  std::optional<double> stroke_mm;
  std::string voltages;
  std::string heads;
  std::vector<std::string> data;
  std::string runs;
  std::string beside;
  std::string picture;
  bool band = false;
  std::vector<std::string> given;  ///< measured curves that narrow the band
  int draws = 0;                   ///< with them: computed at random inputs, to try the linear law
  std::optional<double> tolerance; ///< l/min
  std::vector<std::string> then;
  std::string campaign;
  bool json = false;
  std::vector<std::string> overrides;
  std::vector<std::string> petsc;
};

/// The level beside the curve: at the frequency and stroke that its holder makes. Beside a scene that a
/// voltage drives, a scene keeps its own drive; one that a stroke drives takes the nominal stroke of the
/// curve's data. An emulator, and a scene beside one, take the voltage of the curve. Beside rollers, others
/// turn as fast.
LevelSource read_beside(const HqCommandOptions& options, const Scene& scene, bool of_emulator,
                        const MeasuredCurve* data) {
  const auto& point = scene.operating_point;
  if (point.drive == Drive::voltage) {
    if (!is_scene(options.beside)) {
      return read_level_source(options.beside, {}, point.frequency, {}, point.voltage);
    }
    auto beside = read_level_source(options.beside, {}, point.frequency, {});
    if (of_emulator && beside.scene.operating_point.drive == Drive::voltage) {
      return read_level_source(options.beside, {}, point.frequency, {}, point.voltage);
    }
    if (beside.scene.operating_point.drive == Drive::stroke && data != nullptr && data->stroke_mm) {
      return read_level_source(options.beside, {}, point.frequency, data->stroke_mm);
    }
    return beside;
  }
  if (point.drive == Drive::rollers) {
    return read_level_source(options.beside, {}, point.frequency, {});
  }
  // A projected model knows no scale of the stroke.
  const bool projected = !is_scene(options.beside) && !rom::holds_emulator(options.beside) &&
                         !rom::holds_moving_model(options.beside);
  const double stroke = units::length_to_mm(point.stroke) * (projected ? point.stroke_scale : 1);
  return read_level_source(options.beside, {}, point.frequency, stroke);
}

/// Of the same level at another drive: which.
std::string name_beside(const Level& other, const Level& level, const LevelSource& source,
                        const Scene& scene) {
  const bool told_apart =
      other.name() != level.name() || source.scene.operating_point.drive == scene.operating_point.drive;
  return other.name() + (told_apart ? "" : ", " + setting_text(source.scene.operating_point));
}

/// Runs of another operating point are not drawn.
void warn_of_other_runs(const RecordedCurve& runs, const std::string& file, double frequency_Hz,
                        double stroke_mm) {
  if (!same_setting(runs.frequency_Hz, frequency_Hz) || !same_setting(runs.stroke_mm, stroke_mm)) {
    spdlog::warn("{} holds runs of another operating point, {} Hz, stroke {} mm, which are not drawn", file,
                 plain_number(runs.frequency_Hz), plain_number(runs.stroke_mm));
  }
}

/// A table per curve, what the tolerances do, and what the data tell of the inputs.
void print_tables(std::span<const CurveReport> reports, const std::string& drawn) {
  for (const CurveReport& report : reports) {
    if (reports.size() > 1) {
      std::cout << (&report == reports.data() ? "" : "\n") << setting_text(report.scene.operating_point)
                << "\n";
    }
    std::cout << curve_table(report);
    if (report.band != nullptr) {
      std::cout << "\n" << sensitivity_table(report);
    }
  }
  if (reports.front().band != nullptr && reports.front().band->posterior) {
    std::cout << "\n" << posterior_table(*reports.front().band);
  }
  std::cout << drawn;
}

/// Everything asked for, read and checked.
struct Question {
  LevelSource source;
  std::vector<Scene> scenes; ///< one per curve: the scene at every voltage
  std::vector<double> heads;
  std::vector<MeasuredCurve> measured;
  std::vector<const MeasuredCurve*> beside_curve; ///< by curve, of `measured`; null: none
  std::vector<RecordedCurve> recorded;
  std::vector<TargetCurve> given;
  std::vector<LevelSource> other; ///< by curve; empty: nothing beside
  TierSources tiers;              ///< of --tolerance
};

/// Measured data of every curve: those of its voltage. A single curve takes a single file, with a warning
/// where it was driven otherwise.
std::vector<const MeasuredCurve*> data_of_curves(const HqCommandOptions& options, const Question& question) {
  const bool alone = question.scenes.size() == 1 && question.measured.size() <= 1;
  const std::string asked = question.source.is_model() ? "the model" : "the scene";
  std::vector<const MeasuredCurve*> data(question.scenes.size(), nullptr);
  for (std::size_t m = 0; m < question.measured.size(); ++m) {
    const MeasuredCurve& curve = question.measured[m];
    if (alone) {
      warn_of_other_point(curve, options.data[m], asked, question.scenes.front().operating_point);
      data.front() = &curve;
      continue;
    }
    bool drawn = false;
    for (std::size_t k = 0; k < question.scenes.size(); ++k) {
      if (curve.voltage_V && same_setting(*curve.voltage_V, question.scenes[k].operating_point.voltage)) {
        data[k] = &curve;
        drawn = true;
      }
    }
    if (!drawn) {
      spdlog::warn("{} states none of the voltages of the curves, and is not shown", options.data[m]);
    }
  }
  return data;
}

Question read_question(const HqCommandOptions& options) {
  Question question;
  if (!options.picture.empty()) {
    check_picture_name(options.picture);
  }
  const std::vector<double> voltages =
      options.voltages.empty()
          ? std::vector<double>{}
          : parse_numbers(options.voltages, {"voltages", "V", "40,45 or 36:48:4", "--voltage"});
  // A model has no keys: they are those of the scenes behind it.
  const bool of_scenes_behind = !is_scene(options.file) && std::ranges::any_of(options.then, is_scene);
  question.source = read_level_source(
      options.file, of_scenes_behind ? std::vector<std::string>{} : options.overrides, options.frequency_Hz,
      options.stroke_mm, voltages.empty() ? std::nullopt : std::optional(voltages.front()));
  question.scenes = {question.source.scene};
  for (std::size_t k = 1; k < voltages.size(); ++k) {
    // A model's scene is no whole one, that could be checked.
    question.scenes.push_back(question.source.scene);
    if (question.source.is_model()) {
      question.scenes.back().operating_point.voltage = voltages[k];
    } else {
      question.scenes.back() = with_value(question.source.scene, "operating_point.voltage_V", voltages[k]);
    }
  }
  const Scene& scene = question.scenes.front();
  if (options.band && question.source.is_model()) {
    throw InputError("a reduced model states no tolerances of its inputs", "--band",
                     "--band with a scene (.toml); a reduced model prints its own error", options.file);
  }
  if (options.band) {
    check_tolerances(scene);
  } else if (!options.given.empty()) {
    throw InputError("measured curves narrow a band, and none is asked for", "--given without --band",
                     "--band --given FILE", "--given");
  }
  if (options.draws > 0 && options.given.empty()) {
    throw InputError("draws are of inputs that data narrow, and none are given", "--draws without --given",
                     "--band --given FILE --draws N", "--draws");
  }
  question.heads = options.heads.empty()
                       ? even_heads(units::pressure_to_mmHg(scene.training.head_low),
                                    units::pressure_to_mmHg(scene.training.head_high), default_points)
                       : parse_heads(options.heads);
  for (const std::string& file : options.data) {
    question.measured.push_back(read_measured_curve(file));
  }
  question.beside_curve = data_of_curves(options, question);
  std::vector<MeasuredCurve> given;
  for (const std::string& file : options.given) {
    given.push_back(read_measured_curve(file));
  }
  question.given = target_curves(scene, options.given, given, {}, heads_per_given_curve);
  if (!options.runs.empty()) {
    question.recorded.push_back(read_recorded_curve(options.runs));
    warn_of_other_runs(question.recorded.back(), options.runs, scene.operating_point.frequency,
                       units::length_to_mm(scene.operating_point.stroke));
  }
  if (question.source.model) {
    question.recorded.push_back(
        kept_runs(*question.source.model, scene.operating_point.frequency, *options.stroke_mm));
  }
  if (options.tolerance) {
    question.tiers =
        read_tiers(question.source, options.then,
                   of_scenes_behind ? options.overrides : std::vector<std::string>{}, options.campaign);
  }
  if (!options.beside.empty()) {
    for (std::size_t k = 0; k < question.scenes.size(); ++k) {
      const bool of_runs = question.source.emulator || question.source.moving;
      question.other.push_back(read_beside(options, question.scenes[k], of_runs, question.beside_curve[k]));
    }
  }
  return question;
}

/// Why a tier answered that is not the first, and what may be learnt from its runs.
void tell_tiers(const HqCommandOptions& options, const Question& question,
                std::span<const std::vector<CurvePoint>> curves) {
  bool recorded = false;
  for (const auto& curve : curves) {
    for (const CurvePoint& point : curve) {
      const bool met = point.error_l_per_min <= *options.tolerance;
      if (!met || point.tier != tier_name(question.source)) {
        spdlog::log(met ? spdlog::level::info : spdlog::level::warn, "{} mmHg: {} ({})",
                    plain_number(point.head_mmHg), point.tier, point.why);
      }
      const auto answered = [&](const LevelSource& source) {
        return !source.is_model() && tier_name(source) == point.tier;
      };
      recorded =
          recorded || (!options.campaign.empty() && std::ranges::any_of(question.tiers.sources, answered));
    }
  }
  if (!recorded) {
    return;
  }
  for (const LevelSource& source : question.tiers.sources) {
    if (!source.is_model()) {
      std::string settings;
      for (const std::string& one : options.overrides) {
        settings += " --set '" + one + "'";
      }
      spdlog::info(
          "the runs are in {}; to learn from them: undula train {} --campaign {} --with-recorded{}{}",
          options.campaign, source.file, options.campaign,
          question.source.is_model() ? " --force --output " + options.file : "", settings);
    }
  }
}

bool has_flow(std::span<const CurvePoint> points) {
  return std::ranges::any_of(points,
                             [](const CurvePoint& point) { return std::isfinite(point.flow_l_per_min); });
}

void hq(const HqCommandOptions& options, MPI_Comm comm) {
  // 1. Everything that may be wrong with the input comes before the first result.
  const auto begin = std::chrono::steady_clock::now();
  const Question question = read_question(options);

  // 2. The periodic state at every head, on a level prepared once.
  PhaseTimer timer;
  Tiers tiers;
  std::unique_ptr<Level> alone;
  if (options.tolerance) {
    prepare_tiers(question.tiers, *options.tolerance, comm, timer, tiers);
  } else {
    alone = prepare(question.source, comm, timer);
  }
  Level* const level = alone ? alone.get() : tiers.level.get();
  std::vector<std::vector<CurvePoint>> curves;
  for (const Scene& scene : question.scenes) {
    curves.push_back(curve_with_progress("hq", *level, scene, question.heads, comm));
  }

  // 3. What the tolerances of the inputs do to it; what stands beside it.
  GivenFlows given = given_flows(question.given);
  std::vector<CurveBand> bands;
  if (options.band) {
    bands = bands_of_curves(question.scenes, curves, given, comm);
  }
  std::string drawn;
  if (options.draws > 0) {
    drawn = draw_curves(question.scenes, curves, given, options.draws, comm, bands);
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  std::unique_ptr<Level> other_level;
  std::vector<std::vector<CurvePoint>> beside;
  for (const LevelSource& other : question.other) {
    if (!other_level) {
      PhaseTimer other_timer;
      other_level = prepare(other, comm, other_timer);
    }
    beside.push_back(other_level->curve(other.scene, question.heads));
  }

  // 4. Numbers to stdout, picture beside them.
  on_root(comm, [&] {
    std::vector<CurveReport> reports;
    std::size_t points = 0;
    for (std::size_t k = 0; k < curves.size(); ++k) {
      warn_of_curve(*level, question.scenes[k], curves[k]);
      if (other_level) {
        warn_of_curve(*other_level, question.other[k].scene, beside[k]);
      }
      points += curves[k].size();
      reports.push_back(
          {question.scenes[k], level->name(), question.source.is_model() ? options.file : "",
           level->unknowns(), curves[k], timer, elapsed.count(), question.beside_curve[k],
           bands.empty() ? nullptr : &bands[k],
           other_level ? name_beside(*other_level, *level, question.other[k], question.scenes[k]) : "",
           other_level ? std::span<const CurvePoint>(beside[k]) : std::span<const CurvePoint>(),
           question.recorded});
    }
    if (std::ranges::none_of(curves, [](const auto& curve) { return has_flow(curve); })) {
      throw NumericsError("the curve has no point", "every head", "what the warnings above say");
    }
    if (!options.json) { // JSON holds the time itself
      spdlog::info("{} points in {} s", points, decimals(elapsed.count(), 2));
    }
    if (options.json) {
      std::cout << curves_json(reports);
    } else {
      print_tables(reports, drawn);
    }
    if (!options.picture.empty()) {
      plot_curve_reports(options.picture, reports);
    }
    if (options.tolerance) {
      tell_tiers(options, question, curves);
    }
  });
}

} // namespace

void add_hq_command(CLI::App& app) {
  auto options = std::make_shared<HqCommandOptions>();
  CLI::App* command =
      app.add_subcommand("hq", "Head-flow curve of a reduced model or of a scene (table, JSON, plot)");
  command->add_option("model", options->file, "model file (HDF5) made by undula train, or a scene (.toml)")
      ->required();
  command->add_option("--frequency", options->frequency_Hz,
                      "frequency of the actuator, Hz; a scene has its own");
  CLI::Option* stroke = command->add_option("--stroke", options->stroke_mm,
                                            "amplitude of the actuator, mm; a scene has its own");
  command
      ->add_option(
          "--voltage", options->voltages,
          "of a scene: amplitude of the voltage that drives its actuator, V; several as low:high:step or a "
          "list with commas, a curve each")
      ->excludes(stroke);
  command->add_option(
      "--head", options->heads,
      "heads in mmHg, low:high:step or a list with commas; default: 12 over the training box");
  command
      ->add_option("--data", options->data,
                   "measured points (CSV: head_mmHg,flow_l_per_min); one file per voltage, may be repeated")
      ->allow_extra_args(false);
  command->add_option("--runs", options->runs,
                      "recorded runs to draw beside the curve (what `hq FILE --json` prints)");
  command->add_option("--beside", options->beside,
                      "reduced model (.h5) or scene (.toml) to show beside the curve");
  command->add_option("--plot", options->picture, "picture to draw (.png)");
  command->add_flag("--band", options->band,
                    "of a scene: the band that the tolerances of its inputs give, and what each contributes");
  command
      ->add_option("--given", options->given,
                   "with --band: measured points that narrow it (CSV), may be repeated; docs/calibration.md")
      ->allow_extra_args(false);
  command
      ->add_option("--draws", options->draws,
                   "with --given: so many curves at random inputs, to see whether the band holds them")
      ->check(CLI::Range(1, 100000));
  CLI::Option* tolerance =
      command
          ->add_option(
              "--tolerance", options->tolerance,
              "answer every head by the first of the model and the files of --then whose error is within "
              "this, l/min")
          ->check(CLI::PositiveNumber);
  command
      ->add_option(
          "--then", options->then,
          "with --tolerance: a model or a scene to ask where the ones before are not sure enough, may be "
          "repeated")
      ->needs(tolerance)
      ->allow_extra_args(false);
  command
      ->add_option("--campaign", options->campaign,
                   "with --then SCENE: folder that its runs are recorded in, and read from")
      ->needs(tolerance);
  command->add_flag("--json", options->json, "print JSON");
  command
      ->add_option("--set", options->overrides,
                   "override a key of a scene: section.key=value, may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_option("petsc", options->petsc, "options for PETSc, after -- (scenes)");
  command->callback([options] {
    const auto marches = [](const std::string& file) {
      return is_scene(file) || rom::holds_moving_model(file);
    };
    const bool models_alone = !marches(options->file) &&
                              (options->beside.empty() || !marches(options->beside)) &&
                              std::ranges::none_of(options->then, marches);
    (models_alone ? run_alone : run_parallel)(options->petsc, [&](MPI_Comm comm) { hq(*options, comm); });
  });
}

} // namespace undula::apps
