#include "apps/input/level_source.hpp"

#include <spdlog/spdlog.h>

#include <CLI/Error.hpp>
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <utility>

#include "apps/input/head_list.hpp"
#include "apps/input/reduced_model.hpp"
#include "fom/levels/emulated_level.hpp"
#include "fom/levels/moving_reduced_level.hpp"
#include "fom/levels/reduced_level.hpp"
#include "fom/machines/wave_pump/pump_checks.hpp"
#include "fom/scene/common_problem.hpp"
#include "fom/scene/scene_file.hpp"
#include "fom/scene/scene_value.hpp"
#include "rom/base/error.hpp"
#include "rom/base/text_file.hpp"

namespace undula::apps {
namespace {

/// "membrane.young_dyn_per_cm2=1.6e7", one of the keys that the emulator answers for.
void override_input(const rom::Emulator& emulator, const std::string& text, const std::string& file,
                    Scene& scene) {
  const auto keys = emulated_keys(emulator);
  const auto equals = text.find('=');
  const std::string key = text.substr(0, equals);
  if (std::ranges::find(keys, key) == keys.end()) {
    std::string known;
    for (const std::string& one : keys) {
      known += (known.empty() ? "" : ", ") + one;
    }
    throw InputError("the emulator does not know this key", "--set " + text,
                     known.empty() ? "no --set; --set with a scene (.toml)" : known, file);
  }
  const std::string value = equals == std::string::npos ? "" : text.substr(equals + 1);
  const std::string option = "--set " + key;
  const auto values = parse_numbers(value, {"value of the key", "", "1.6e7", option.c_str()});
  if (values.size() != 1) {
    throw InputError("a key has one value", "--set " + text, "key=value", file);
  }
  set_value(scene, key, values.front());
}

LevelSource read_model_source(const std::string& file, const std::vector<std::string>& overrides,
                              const std::optional<double>& frequency_Hz,
                              const std::optional<double>& stroke_mm,
                              const std::optional<double>& voltage_V) {
  const bool is_emulator = std::filesystem::exists(file) && rom::holds_emulator(file);
  if (!overrides.empty() && !is_emulator) {
    throw InputError("a reduced model has no keys to override", "--set " + overrides.front(),
                     "--set with a scene (.toml)", file);
  }
  if (is_emulator) {
    if (!frequency_Hz) {
      throw CLI::RequiredError("--frequency");
    }
    LevelSource source;
    source.file = file;
    source.emulator = rom::load_emulator(file);
    source.scene = scene_of_emulator(*source.emulator, file, *frequency_Hz, stroke_mm, voltage_V);
    for (const std::string& text : overrides) {
      override_input(*source.emulator, text, file, source.scene);
    }
    return source;
  }
  if (rom::holds_moving_model(file)) {
    if (!frequency_Hz) {
      throw CLI::RequiredError("--frequency");
    }
    LevelSource source;
    source.file = file;
    source.moving = rom::load_moving_model(file);
    source.scene = scene_of_moving_model(*source.moving, file, *frequency_Hz, {stroke_mm, voltage_V});
    return source;
  }
  if (voltage_V) {
    throw InputError("a reduced model of this version is driven by a stroke",
                     "--voltage " + exact_number(*voltage_V),
                     "--stroke; or an emulator, or a scene with [actuator]", file);
  }
  if (!frequency_Hz || !stroke_mm) {
    throw CLI::RequiredError(frequency_Hz ? "--stroke" : "--frequency");
  }
  rom::check_operating_point(*frequency_Hz, *stroke_mm, {});
  LevelSource source;
  source.file = file;
  source.model = read_model(file);
  source.scene =
      scene_of_model(*source.model, std::filesystem::path(file).stem().string(), *frequency_Hz, *stroke_mm);
  return source;
}

} // namespace

bool is_scene(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending == ".toml";
}

void warn_of_profile(const Scene& scene) {
  for (const std::string& sentence : profile_differences(scene)) {
    spdlog::warn("{}", sentence);
  }
}

LevelSource read_level_source(const std::string& file, std::vector<std::string> overrides,
                              const std::optional<double>& frequency_Hz,
                              const std::optional<double>& stroke_mm,
                              const std::optional<double>& voltage_V) {
  if (!is_scene(file)) {
    return read_model_source(file, overrides, frequency_Hz, stroke_mm, voltage_V);
  }
  if (frequency_Hz) {
    overrides.push_back("operating_point.frequency_Hz=" + exact_number(*frequency_Hz));
  }
  if (stroke_mm) {
    overrides.push_back("operating_point.stroke_mm=" + exact_number(*stroke_mm));
  }
  if (voltage_V) {
    overrides.emplace_back("operating_point.drive=voltage");
    overrides.push_back("operating_point.voltage_V=" + exact_number(*voltage_V));
  }
  LevelSource source;
  source.file = file;
  source.scene = read_scene(file, overrides);
  require_pump(source.scene, "a head-flow curve");
  warn_of_profile(source.scene);
  return source;
}

std::unique_ptr<Level> prepare(const LevelSource& source, MPI_Comm comm, PhaseTimer& timer) {
  if (source.model) {
    return std::make_unique<ReducedLevel>(*source.model);
  }
  if (source.emulator) {
    return std::make_unique<EmulatedLevel>(*source.emulator);
  }
  if (source.moving) {
    return std::make_unique<MovingReducedLevel>(*source.moving, source.file, comm, timer);
  }
  return prepare_level(source.scene, comm, timer);
}

} // namespace undula::apps
