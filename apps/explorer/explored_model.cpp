#include "apps/explorer/explored_model.hpp"

#include <toml++/toml.h>

#include <filesystem>
#include <map>

#include "apps/input/reduced_model.hpp"
#include "apps/input/scene_at_point.hpp"
#include "fom/levels/emulated_level.hpp"
#include "fom/levels/reduced_level.hpp"
#include "rom/base/error.hpp"
#include "rom/curve/stated_drive.hpp"

namespace undula::apps {
namespace {

using Json = nlohmann::ordered_json;

Json range_json(const char* name, const char* unit, double low, double high) {
  return {{"name", name}, {"unit", unit}, {"low", low}, {"high", high}};
}

/// Density and viscosity of the scene that the runs were of.
Json fluid_json(const std::string& scene) {
  try {
    const toml::table table = toml::parse(scene);
    // A key may state a tolerance: { value = 0.035, tolerance = 0.002 }.
    const auto number = [&](const char* key) -> Json {
      const auto node = table["fluid"][key];
      const auto value = node.is_table() ? node["value"].value<double>() : node.value<double>();
      return value ? Json(*value) : Json();
    };
    const Json fluid = {{"density_g_per_cm3", number("density_g_per_cm3")},
                        {"viscosity_poise", number("viscosity_poise")}};
    return fluid["viscosity_poise"].is_null() ? Json() : fluid;
  } catch (const toml::parse_error&) {
    return {};
  }
}

} // namespace

ExploredModel::ExploredModel(const std::string& file) {
  constexpr const char* allowed =
      "a reduced model of a fixed domain, or an emulator (.h5), that undula train made";
  if (is_scene(file)) {
    throw InputError("scenes take too long to be explored", file, allowed, "undula explore");
  }
  source_.file = file;
  if (std::filesystem::exists(file) && rom::holds_emulator(file)) {
    source_.emulator = rom::load_emulator(file);
    level_ = std::make_unique<EmulatedLevel>(*source_.emulator);
    return;
  }
  if (rom::holds_moving_model(file)) {
    throw InputError("reduced models of moving domains take minutes per point", file, allowed,
                     "undula explore");
  }
  source_.model = read_model(file);
  level_ = std::make_unique<ReducedLevel>(*source_.model);
}

rom::TrainingBox ExploredModel::box() const {
  return source_.emulator ? rom::training_box(*source_.emulator) : source_.model->box;
}

const std::string& ExploredModel::told_scene() const {
  static const std::string nothing;
  const auto& provenance = source_.emulator ? source_.emulator->provenance : source_.model->provenance;
  const auto found = provenance.find("scene");
  return found == provenance.end() ? nothing : found->second;
}

std::string ExploredModel::no_period() const {
  if (!source_.emulator) {
    return "";
  }
  if (!source_.emulator->responses.empty()) {
    return "This page does not draw the period of an emulator: undula period does. Its inflow is not known.";
  }
  return "An emulator interpolates means of runs: how membrane and flow go in time is not known to it. A "
         "projected model knows.";
}

Json ExploredModel::description() const {
  const auto b = box();
  return {
      {"model", std::filesystem::path(source_.file).filename().string()},
      {"level", level_->name()},
      {"unknowns", level_->unknowns()},
      {"ranges",
       {{"frequency", range_json("frequency", "Hz", b.frequency_low_Hz, b.frequency_high_Hz)},
        {"drive", range_json(by_voltage() ? "voltage" : "stroke", by_voltage() ? "V" : "mm", b.stroke_low_mm,
                             b.stroke_high_mm)},
        {"head", range_json("head", "mmHg", b.head_low_mmHg, b.head_high_mmHg)}}},
      {"fluid", fluid_json(told_scene())},
      {"no_period", no_period()},
      {"no_scene", told_scene().empty() ? "The model does not tell the scene that it was made from." : ""}};
}

Scene ExploredModel::scene_of(double frequency_Hz, double drive) const {
  if (source_.model) {
    rom::check_operating_point(frequency_Hz, drive, {});
    return scene_of_model(*source_.model, std::filesystem::path(source_.file).stem().string(), frequency_Hz,
                          drive);
  }
  const auto stated = std::optional(drive);
  return by_voltage() ? scene_of_emulator(*source_.emulator, source_.file, frequency_Hz, {}, stated)
                      : scene_of_emulator(*source_.emulator, source_.file, frequency_Hz, stated, {});
}

void ExploredModel::require_inside(double frequency_Hz, double drive,
                                   std::span<const double> heads_mmHg) const {
  const rom::DriveUnit unit = by_voltage() ? rom::DriveUnit{"voltage", "V"} : rom::DriveUnit{"stroke", "mm"};
  const auto outside = rom::outside_training_box(box(), frequency_Hz, drive, heads_mmHg, unit);
  if (!outside.empty()) {
    throw InputError("the explorer stays in the box of the model", outside.front(), "the ranges of the page",
                     std::filesystem::path(source_.file).filename().string());
  }
}

rom::PumpPeriod ExploredModel::period(double frequency_Hz, double drive, double head_mmHg) const {
  if (!source_.model) {
    throw InputError("the course of a period is not known", "an emulator, which interpolates means of runs",
                     "a projected model", std::filesystem::path(source_.file).filename().string());
  }
  require_inside(frequency_Hz, drive, std::span(&head_mmHg, 1));
  return rom::pump_period(*source_.model, frequency_Hz, rom::stroke_of_scenes(drive), head_mmHg);
}

std::string ExploredModel::scene_text(double frequency_Hz, double drive, double head_mmHg) const {
  const std::string name = std::filesystem::path(source_.file).filename().string();
  if (told_scene().empty()) {
    throw InputError("the model does not tell its scene", "no scene in its provenance",
                     "a model that undula train made", name);
  }
  require_inside(frequency_Hz, drive, std::span(&head_mmHg, 1));
  const auto& provenance = source_.emulator ? source_.emulator->provenance : source_.model->provenance;
  const auto version = provenance.find("version");
  return "# The scene that " + name +
         " was made from, at an operating point of undula explore. The profile it names\n" +
         "# has to stand beside it. Keys that version " +
         (version == provenance.end() ? std::string("unknown") : version->second) +
         " did not have take the defaults of the version that reads it.\n" +
         scene_at_point(told_scene(), {{"frequency_Hz", frequency_Hz},
                                       {by_voltage() ? "voltage_V" : "stroke_mm", drive},
                                       {"head_mmHg", head_mmHg}});
}

} // namespace undula::apps
